// The view depth of pixels, where the ground counts as a surface.
#define_import_path shadowgraph::ground_depth
#import shadowgraph::view::{view_depth_from_depth, view_depth_of, view_ray}

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
    let ray = view_ray(pixel);
    let above = ray.start.y - ground.height;
    if above <= 0.0 || ray.direction.y > -1.0 / FARTHEST {
        return 0.0;
    }
    return view_depth_of(ray.start - ray.direction * (above / ray.direction.y));
}
