// The camera and the lights of a frame: group 0 of every lit pass.
#define_import_path shadowgraph::view

// Positions are metres relative to the frame's origin. Depth is reversed: near 1, far 0. 256 bytes, and the noise.
struct View {
    clip_from_world: mat4x4f,
    world_from_clip: mat4x4f,
    view_from_world: mat4x4f,
    // The camera.
    position: vec3f,
    near: f32,
    size_px: vec2f,
    // 0: infinitely far (perspective only).
    far: f32,
    // Multiplies the output of lit passes.
    exposure: f32,
    // Radiance of the sky above and of the ground below, before exposure.
    ambient_sky: vec3f,
    light_count: u32,
    ambient_ground: vec3f,
    // 1: orthographic, 0: perspective.
    orthographic: u32,
    // See shadowgraph::frame_noise: one element if noise is the same in every frame.
    noise: array<vec4u>,
}

const LIGHT_DIRECTIONAL: u32 = 0u;
const LIGHT_SPOT: u32 = 1u;
const LIGHT_POINT: u32 = 2u;

// 64 bytes, the last 12 of them padding.
struct Light {
    position: vec3f,
    kind: u32,
    // The direction in which the light travels, unit length.
    direction: vec3f,
    // Metres; 0: unlimited.
    range: f32,
    // Linear colour times lux (directional) or candela (spot, point).
    color: vec3f,
    // Spot cone: saturate(cos(angle) * spot_scale + spot_offset) squared.
    spot_scale: f32,
    spot_offset: f32,
}

@group(0) @binding(0) var<storage, read> view: View;
@group(0) @binding(1) var<storage, read> lights: array<Light>;

// View depth of a point, metres in front of the camera.
fn view_depth_of(position: vec3f) -> f32 {
    return -(view.view_from_world * vec4f(position, 1.0)).z;
}

// View depth of a value of the depth buffer, metres. The far plane's value (0) has none in an infinite view: check
// `depth > 0` first.
fn view_depth_from_depth(depth: f32) -> f32 {
    if view.orthographic == 1u {
        return view.far - depth * (view.far - view.near);
    }
    if view.far == 0.0 {
        return view.near / depth;
    }
    return view.near * view.far / (view.near + depth * (view.far - view.near));
}

// Pixels per metre at this view depth.
fn pixels_per_metre(depth: f32) -> f32 {
    // The second row of the projection: one unit of height at depth 1, in halves of the image's height.
    let m = view.clip_from_world;
    let up = length(vec3f(m[0].y, m[1].y, m[2].y)) * 0.5 * view.size_px.y;
    return select(up / max(depth, 1e-6), up, view.orthographic == 1u);
}

// A ray into the scene, from the near plane.
struct ViewRay {
    start: vec3f,
    // Unit length.
    direction: vec3f,
}

// The ray through a point of the image, in pixels.
fn view_ray(pixel: vec2f) -> ViewRay {
    let ndc = pixel / view.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let near = view.world_from_clip * vec4f(ndc, 1.0, 1.0);
    let far = view.world_from_clip * vec4f(ndc, 0.5, 1.0);
    let start = near.xyz / near.w;
    return ViewRay(start, normalize(far.xyz / far.w - start));
}

// The direction to the camera, unit length, from a point relative to the camera.
fn direction_to_camera(from_camera: vec3f) -> vec3f {
    if view.orthographic == 1u {
        // The third row of the rotation: the view's +Z axis, which points from the scene to the camera.
        let m = view.view_from_world;
        return normalize(vec3f(m[0].z, m[1].z, m[2].z));
    }
    return normalize(-from_camera);
}

// The offset from a point to where the next pixel right (axis 0) or up (1) meets the plane of its surface. Unlike derivatives
// it does not depend on the surfaces of the neighbours.
fn to_neighbour(position: vec3f, normal: vec3f, view_depth: f32, axis: i32) -> vec3f {
    let m = view.view_from_world;
    let across = vec3f(m[0][axis], m[1][axis], m[2][axis]);
    // That row of the projection: the size of one unit at depth 1, in halves of the image.
    let c = view.clip_from_world;
    let scale = length(vec3f(c[0][axis], c[1][axis], c[2][axis]));
    let step = across * 2.0 / (view.size_px[axis] * scale);
    if view.orthographic == 1u {
        let forward = -vec3f(m[0].z, m[1].z, m[2].z);
        return step - forward * (dot(normal, step) / away_from_zero(dot(normal, forward)));
    }
    let from_camera = position - view.position;
    let other = from_camera + step * view_depth;
    return other * (dot(normal, from_camera) / away_from_zero(dot(normal, other))) - from_camera;
}

// Bounds the derivatives of surfaces seen edge-on.
fn away_from_zero(x: f32) -> f32 {
    return select(min(x, -1e-6), max(x, 1e-6), x >= 0.0);
}
