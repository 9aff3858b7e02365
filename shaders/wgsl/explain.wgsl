// Writes what a technique says about single points, and the visibility there: each point is a row of the results.
#import shadowgraph::explanation::explain_shadow
#import shadowgraph::receiver::{Receiver, RECEIVER_OFF_SCREEN}
#import shadowgraph::technique::shadow_visibility

// 80 bytes.
struct Point {
    // Metres relative to the frame's origin.
    position: vec3f,
    // Metres in front of the camera.
    view_depth: f32,
    // Towards the camera, unit length.
    normal: vec3f,
    light: u32,
    // Change of position to the next pixel right and down.
    right: vec3f,
    down: vec3f,
    // Pixel centre in the image.
    pixel: vec2f,
}

const POINTS: u32 = 64u;
const FACTS: u32 = 32u;

@group(2) @binding(0) var<uniform> points: array<Point, POINTS>;
@group(2) @binding(1) var results: texture_storage_2d<r32float, write>;

@compute @workgroup_size(1)
fn cs_explain(@builtin(workgroup_id) id: vec3u) {
    let point = points[id.x];
    let receiver = Receiver(
        point.position,
        point.view_depth,
        point.normal,
        RECEIVER_OFF_SCREEN,
        point.normal,
        point.pixel,
        point.right,
        point.down,
    );
    var facts = explain_shadow(point.light, receiver);
    for (var i = 0u; i < FACTS; i++) {
        textureStore(results, vec2u(i, id.x), vec4f(facts[i]));
    }
    let visibility = shadow_visibility(point.light, receiver);
    textureStore(results, vec2u(FACTS, id.x), vec4f(visibility.x));
    textureStore(results, vec2u(FACTS + 1u, id.x), vec4f(visibility.y));
    textureStore(results, vec2u(FACTS + 2u, id.x), vec4f(visibility.z));
}
