// Mesh surfaces for passes that shade: their vertices, materials and normals.
#define_import_path shadowgraph::mesh
#import shadowgraph::view::{view, view_depth_of, direction_to_camera, to_neighbour}
#import shadowgraph::frame_noise::noise_flags
#import shadowgraph::draw::{
    Vertex, world_position, world_normal, world_direction, handedness, clip_position,
}
#import shadowgraph::material::{
    MATERIAL_MASK, MATERIAL_BLEND, MATERIAL_NORMAL_MAP, NORMAL, TextureCoordinates, has_texture, material_has,
    base_color, metallic_roughness, occlusion, emissive, normal_in_tangent_space, is_hole,
}
#import shadowgraph::receiver::{Receiver, RECEIVER_TRANSPARENT, RECEIVER_BACK_FACE}

struct MeshVertex {
    @invariant @builtin(position) position: vec4f,
    // Relative to the camera: its small numbers keep the derivatives precise where they matter, nearby.
    @location(0) from_camera: vec3f,
    @location(1) normal: vec3f,
    // w: handedness of the bitangent.
    @location(2) tangent: vec4f,
    @location(3) uv_first: vec2f,
    @location(4) uv_second: vec2f,
    @location(5) color: vec4f,
}

fn mesh_vertex(vertex: Vertex) -> MeshVertex {
    let position = world_position(vertex.instance, vertex.position);
    let side = vertex.tangent.w * handedness(vertex.instance);
    return MeshVertex(
        clip_position(view.clip_from_world, position),
        position - view.position,
        world_normal(vertex.instance, vertex.normal),
        vec4f(world_direction(vertex.instance, vertex.tangent.xyz), side),
        vertex.uv_first,
        vertex.uv_second,
        vertex.color,
    );
}

// The surface of a mesh's fragment.
struct MeshSurface {
    // Linear.
    color: vec4f,
    // x: metallic, y: perceptual roughness.
    metal_rough: vec2f,
    // 1: not occluded.
    ambient_occlusion: f32,
    // Radiance, before exposure.
    emission: vec3f,
    to_camera: vec3f,
    // Shading normal.
    normal: vec3f,
    receiver: Receiver,
}

// For fragments: discards the holes of masked materials. Call in uniform control flow.
fn mesh_surface(in: MeshVertex, front_facing: bool) -> MeshSurface {
    // Derivatives come before the first non-uniform branch.
    let ddx_position = dpdx(in.from_camera);
    let ddy_position = dpdy(in.from_camera);
    let uv = TextureCoordinates(in.uv_first, in.uv_second);
    let color = base_color(uv, in.color);
    let metal_rough = metallic_roughness(uv);
    let ambient_occlusion = occlusion(uv);
    let emission = emissive(uv);
    let to_camera = direction_to_camera(in.from_camera);
    let normal = shading_normal(in, uv, front_facing, to_camera);
    if material_has(MATERIAL_MASK) && is_hole(color.a) {
        discard;
    }
    let receiver = receiver_of(in, ddx_position, ddy_position, normal, to_camera, front_facing);
    return MeshSurface(color, metal_rough, ambient_occlusion, emission, to_camera, normal, receiver);
}

// `fallback` for a direction of length 0.
fn normalize_or(direction: vec3f, fallback: vec3f) -> vec3f {
    let length_squared = dot(direction, direction);
    if length_squared > 1e-30 {
        return direction * inverseSqrt(length_squared);
    }
    return fallback;
}

// The triangle's normal, on the side that the camera sees, for front and back faces alike.
fn geometric_normal(ddx_position: vec3f, ddy_position: vec3f, to_camera: vec3f, shading_normal: vec3f) -> vec3f {
    // Normalised first: up close, the product of two derivatives is too small.
    let right = normalize_or(ddx_position, vec3f(0.0));
    let down = normalize_or(ddy_position, vec3f(0.0));
    let n = normalize_or(cross(right, down), shading_normal);
    return select(n, -n, dot(n, to_camera) < 0.0);
}

// Reads a texture: call in uniform control flow.
fn shading_normal(in: MeshVertex, uv: TextureCoordinates, front_facing: bool, to_camera: vec3f) -> vec3f {
    let smooth_normal = normalize_or(in.normal, to_camera);
    var normal = smooth_normal;
    if has_texture(NORMAL) && material_has(MATERIAL_NORMAL_MAP) {
        let projected = in.tangent.xyz - smooth_normal * dot(in.tangent.xyz, smooth_normal);
        let tangent = normalize_or(projected, vec3f(0.0));
        let bitangent = cross(smooth_normal, tangent) * in.tangent.w;
        let mapped = normal_in_tangent_space(uv);
        normal = normalize_or(
            tangent * mapped.x + bitangent * mapped.y + smooth_normal * mapped.z, smooth_normal);
    }
    return select(-normal, normal, front_facing);
}

// The receiver of a fragment. The derivatives are those of `in.from_camera`.
fn receiver_of(
    in: MeshVertex, ddx_position: vec3f, ddy_position: vec3f, normal: vec3f, to_camera: vec3f, front_facing: bool,
) -> Receiver {
    let position = in.from_camera + view.position;
    let view_depth = view_depth_of(position);
    let flat_normal = geometric_normal(ddx_position, ddy_position, to_camera, normal);
    let blended = material_has(MATERIAL_BLEND);
    return Receiver(
        position,
        view_depth,
        flat_normal,
        select(0u, RECEIVER_TRANSPARENT, blended) | select(RECEIVER_BACK_FACE, 0u, front_facing)
            | noise_flags(in.position.xy),
        normal,
        in.position.xy,
        to_neighbour(position, flat_normal, view_depth, 0),
        -to_neighbour(position, flat_normal, view_depth, 1),
    );
}
