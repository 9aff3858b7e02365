// The lights of a frame with few of them, in a uniform block: in fragment shaders Mesa's software driver reads storage buffers pixel by
// pixel. They are read as vectors of four words, as in `few_views.wgsl`.
#define_import_path shadowgraph::lights
#import shadowgraph::light::{Light, LIGHT_DIRECTIONAL}
#import shadowgraph::view::view

const FEW_LIGHTS: u32 = 32u;
// Whether there is exactly one light, a directional one.
const ONLY_SUN: bool = false;

// Vectors of a Light.
const LIGHT_WORDS: u32 = 4u;

@group(0) @binding(1) var<uniform> lights: array<array<vec4f, LIGHT_WORDS>, FEW_LIGHTS>;

fn light_count() -> u32 {
    return select(view.light_count, 1u, ONLY_SUN);
}

// The index is never constant: Mesa's software driver compiles a shader again for each value at a constant offset that a branch depends on,
// and corrupts memory if there are more than four in a block.
fn light_at(index: u32) -> Light {
    if ONLY_SUN {
        return Light(vec3f(0.0), LIGHT_DIRECTIONAL, lights[view.zero][1].xyz, 0.0, lights[view.zero][2].xyz, 0.0, 0.0);
    }
    let light = min(index + view.zero, FEW_LIGHTS - 1u);
    let position = lights[light][0];
    let direction = lights[light][1];
    let color = lights[light][2];
    return Light(
        position.xyz, bitcast<u32>(position.w), direction.xyz, direction.w, color.xyz, color.w, lights[light][3].x,
    );
}
