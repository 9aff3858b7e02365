// The lights of a frame with few of them, in a uniform block: in fragment shaders Mesa's software driver reads storage buffers pixel by
// pixel.
#define_import_path shadowgraph::lights
#import shadowgraph::light::{Light, LIGHT_DIRECTIONAL}
#import shadowgraph::view::view

const FEW_LIGHTS: u32 = 32u;
// Whether there is exactly one light, a directional one.
const ONLY_SUN: bool = false;

@group(0) @binding(1) var<uniform> lights: array<Light, FEW_LIGHTS>;

fn light_count() -> u32 {
    return select(view.light_count, 1u, ONLY_SUN);
}

// The index is never constant: Mesa's software driver compiles a shader again for each value at a constant offset that a branch depends on,
// and corrupts memory if there are more than four in a block.
fn light_at(index: u32) -> Light {
    if ONLY_SUN {
        let sun = lights[view.zero];
        return Light(vec3f(0.0), LIGHT_DIRECTIONAL, sun.direction, 0.0, sun.color, 0.0, 0.0);
    }
    return lights[min(index + view.zero, FEW_LIGHTS - 1u)];
}
