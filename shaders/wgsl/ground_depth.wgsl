// The view depth of pixels, where the ground counts as a surface.
#define_import_path shadowgraph::ground_depth
#import shadowgraph::view::{view, view_depth_from_depth}

// A horizontal plane, seen from above.
struct GroundPlane {
    // Metres relative to the frame's origin.
    height: f32,
    // 1 if there is one.
    exists: u32,
}

// Beyond, the ground counts as infinitely far, in multiples of the camera's height.
const FARTHEST: f32 = 1000.0;

// The view depth of a pixel's surface, or of the ground where nothing is drawn, metres; 0 for neither.
fn surface_view_depth(depth: f32, pixel: vec2f, ground: GroundPlane) -> f32 {
    if depth > 0.0 {
        return view_depth_from_depth(depth);
    }
    if ground.exists == 0u {
        return 0.0;
    }
    let ndc = pixel / view.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let near = view.world_from_clip * vec4f(ndc, 1.0, 1.0);
    let far = view.world_from_clip * vec4f(ndc, 0.5, 1.0);
    let start = near.xyz / near.w;
    let direction = normalize(far.xyz / far.w - start);
    let above = start.y - ground.height;
    if above <= 0.0 || direction.y > -1.0 / FARTHEST {
        return 0.0;
    }
    let position = start - direction * (above / direction.y);
    return -(view.view_from_world * vec4f(position, 1.0)).z;
}
