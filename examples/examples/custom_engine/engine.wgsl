// The engine's shader. It imports the receiver and the technique's function from Shadowgraph.
#import shadowgraph::receiver::Receiver
#import shadowgraph::technique::shadow_visibility

struct Box {
    center: vec4f,
    half: vec4f,
}

struct EngineView {
    clip_from_world: mat4x4f,
    eye: vec4f,
    to_light: vec4f,
}

// Bindings of the lit pass.
@group(0) @binding(0) var<uniform> engine_view: EngineView;
@group(0) @binding(1) var<storage, read> boxes: array<Box>;

// Bindings of shadow passes: the view begins with its matrix.
@group(0) @binding(0) var<storage, read> caster_from_world: mat4x4f;
@group(1) @binding(0) var<storage, read> caster_boxes: array<Box>;

struct Corner {
    position: vec3f,
    normal: vec3f,
}

// Corner 0 to 35 of the twelve triangles of a box.
fn corner(box: Box, index: u32) -> Corner {
    let axis = index / 12u;
    let side = f32((index / 6u) % 2u) * 2.0 - 1.0;
    let quad = array<vec2f, 6>(
        vec2f(-1.0, -1.0), vec2f(1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, 1.0));
    let at = quad[index % 6u];
    var normal = vec3f(0.0);
    var offset = vec3f(0.0);
    normal[axis] = side;
    offset[axis] = side;
    offset[(axis + 1u) % 3u] = at.x;
    offset[(axis + 2u) % 3u] = at.y;
    return Corner(box.center.xyz + offset * box.half.xyz, normal);
}

@vertex
fn vs_caster(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> @builtin(position) vec4f {
    let clip = caster_from_world * vec4f(corner(caster_boxes[instance], vertex).position, 1.0);
    // Geometry in front of the near plane casts shadows too.
    return vec4f(clip.xy, min(clip.z, clip.w), clip.w);
}

struct Lit {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) @interpolate(flat) normal: vec3f,
}

@vertex
fn vs_lit(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Lit {
    let corner = corner(boxes[instance], vertex);
    return Lit(engine_view.clip_from_world * vec4f(corner.position, 1.0), corner.position, corner.normal);
}

@fragment
fn fs_lit(in: Lit) -> @location(0) vec4f {
    let depth = 1.0 / in.clip.w;
    let receiver = Receiver(
        in.position, depth, in.normal, 0u, in.normal, in.clip.xy, dpdx(in.position), dpdy(in.position));
    let n_dot_l = max(dot(in.normal, engine_view.to_light.xyz), 0.0);
    let light = vec3f(0.9, 0.85, 0.75) * n_dot_l * shadow_visibility(0u, receiver);
    let sky = vec3f(0.12, 0.15, 0.2) * (0.7 + 0.3 * in.normal.y);
    return vec4f(vec3f(0.8) * (light + sky), 1.0);
}
