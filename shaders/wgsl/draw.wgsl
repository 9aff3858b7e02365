// Instance transforms, group 3 of every pass that draws meshes, and the vertices of a mesh.
#define_import_path shadowgraph::draw

// Rows of the affine matrix world_from_local of this frame and of the previous one; world is relative to the frame's origin
// in both. 112 bytes.
struct Instance {
    row_x: vec4f,
    row_y: vec4f,
    row_z: vec4f,
    previous_row_x: vec4f,
    previous_row_y: vec4f,
    previous_row_z: vec4f,
    // The batch, then flags: see cull.wgsl.
    flags: vec4u,
}

@group(3) @binding(0) var<storage, read> instances: array<Instance>;
// The drawn instances, by `instance_index`, which counts from the draw's first instance.
@group(3) @binding(1) var<storage, read> drawn: array<u32>;

struct Vertex {
    @builtin(instance_index) instance: u32,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    // w: handedness of the bitangent, 1 or -1.
    @location(2) tangent: vec4f,
    @location(3) uv_first: vec2f,
    @location(4) uv_second: vec2f,
    @location(5) color: vec4f,
}

fn world_position(instance: u32, position: vec3f) -> vec3f {
    let m = instances[drawn[instance]];
    let p = vec4f(position, 1.0);
    return vec3f(dot(m.row_x, p), dot(m.row_y, p), dot(m.row_z, p));
}

// The position in the previous frame of a vertex that had this one in the space of the instance, relative to this frame's origin.
fn previous_world_position(instance: u32, position: vec3f) -> vec3f {
    let m = instances[drawn[instance]];
    let p = vec4f(position, 1.0);
    return vec3f(dot(m.previous_row_x, p), dot(m.previous_row_y, p), dot(m.previous_row_z, p));
}

// A direction in the surface (a tangent): not unit length.
fn world_direction(instance: u32, direction: vec3f) -> vec3f {
    let m = instances[drawn[instance]];
    return vec3f(dot(m.row_x.xyz, direction), dot(m.row_y.xyz, direction), dot(m.row_z.xyz, direction));
}

// -1 where the instance is mirrored, else 1.
fn handedness(instance: u32) -> f32 {
    let m = instances[drawn[instance]];
    return select(1.0, -1.0, dot(m.row_x.xyz, cross(m.row_y.xyz, m.row_z.xyz)) < 0.0);
}

// The outward normal, not unit length. Cofactors replace the inverse transpose: they give the same direction under any scale
// and are defined where a scale is 0. They flip when mirrored; an outward normal does not.
fn world_normal(instance: u32, normal: vec3f) -> vec3f {
    let m = instances[drawn[instance]];
    let cofactor_x = cross(m.row_y.xyz, m.row_z.xyz);
    let cofactor_y = cross(m.row_z.xyz, m.row_x.xyz);
    let cofactor_z = cross(m.row_x.xyz, m.row_y.xyz);
    let normal_world = vec3f(dot(cofactor_x, normal), dot(cofactor_y, normal), dot(cofactor_z, normal));
    return normal_world * handedness(instance);
}

// All passes that must have bit-identical depth compute positions with this function, for an @invariant output.
fn clip_position(clip_from_world: mat4x4f, position: vec3f) -> vec4f {
    return clip_from_world * vec4f(position, 1.0);
}
