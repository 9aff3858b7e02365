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

// The largest view depth of the ground, in multiples of the camera's height; beyond, it counts as infinitely far.
const FARTHEST: f32 = 1000.0;

// The view depth of a pixel's surface, or of the ground where nothing is drawn, metres; 0 for neither.
fn surface_view_depth(depth: f32, pixel: vec2f, ground: GroundPlane) -> f32 {
    if depth > 0.0 {
        return view_depth_from_depth(depth);
    }
    if ground.exists == 0u {
        return 0.0;
    }
    // All in heights: the step from the middle of the image to the pixel, at 1 m in front of the camera; the start of the pixel's ray
    // above the ground; and its fall in each metre of view depth.
    let offset = pixel - 0.5 * view.size_px;
    let across = view.pixel_right.y * offset.x - view.pixel_up.y * offset.y;
    let forward = -view.view_from_world[1].z;
    let is_orthographic = view.orthographic == 1u;
    let above = view.position.y + select(0.0, across, is_orthographic) - ground.height;
    let fall = -forward - select(across, 0.0, is_orthographic);
    let is_seen = above > 0.0 && fall > 1.0 / FARTHEST;
    return select(0.0, above / fall, is_seen);
}
