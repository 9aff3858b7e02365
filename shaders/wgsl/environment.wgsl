// Ambient light without a sky: a colour from above and one from below. A pass with a sky replaces
// this module by `sky_light.wgsl`.
#define_import_path shadowgraph::environment
#import shadowgraph::view::view
#import shadowgraph::lighting::{Surface, ambient}

// Whether there is a background to draw.
const HAS_BACKGROUND: bool = false;

// Radiance towards the camera, before exposure.
fn environment_light(surface: Surface) -> vec3f {
    return ambient(surface, view.ambient_sky, view.ambient_ground);
}

// The background of a pixel, exposure applied.
fn background_light(pixel: vec2f) -> vec4f {
    return vec4f(0.0);
}
