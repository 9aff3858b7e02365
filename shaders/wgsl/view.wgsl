// The camera of a frame: group 0 of every lit pass, with the lights.
#define_import_path shadowgraph::view

// Positions are metres relative to the frame's origin. Depth is reversed: near 1, far 0. 288 bytes, and the noise.
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
    // The steps to the next pixel right and up, metres at 1 m in front of the camera; at any distance, if it is orthographic.
    pixel_right: vec3f,
    // See shadowgraph::frame_noise. 1: noise changes from frame to frame; 0: it is not read.
    noise_changes: u32,
    pixel_up: vec3f,
    // 0, for indices that are not constant.
    zero: u32,
    noise: array<vec4u, 64>,
}

@group(0) @binding(0) var<uniform> view: View;

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
    // Without a branch, which Mesa's software driver would compile again for each value of `far`.
    let finite = view.near * view.far / (view.near + depth * (view.far - view.near));
    return select(finite, view.near / depth, view.far == 0.0);
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
    let points = view_ray_points(pixel / view.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0));
    return ViewRay(points[0], normalize(points[1] - points[0]));
}

// Two points of the ray through a point of the image, in clip space: the first on the near plane. They are linear over the image.
fn view_ray_points(ndc: vec2f) -> array<vec3f, 2> {
    let near = view.world_from_clip * vec4f(ndc, 1.0, 1.0);
    let far = view.world_from_clip * vec4f(ndc, 0.5, 1.0);
    return array(near.xyz / near.w, far.xyz / far.w);
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
    let step = select(view.pixel_right, view.pixel_up, axis == 1);
    if view.orthographic == 1u {
        let m = view.view_from_world;
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
