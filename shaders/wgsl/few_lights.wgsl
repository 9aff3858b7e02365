// The lights of a frame with few of them, in a uniform block: in fragment shaders Mesa's software driver reads storage buffers pixel by
// pixel.
#define_import_path shadowgraph::lights
#import shadowgraph::light::Light
#import shadowgraph::view::view

const FEW_LIGHTS: u32 = 32u;
// Whether there is exactly one light.
const ONLY_ONE: bool = false;

@group(0) @binding(1) var<uniform> lights: array<Light, FEW_LIGHTS>;

fn light_count() -> u32 {
    return select(view.light_count, 1u, ONLY_ONE);
}

// The index is never constant: Mesa's software driver compiles a shader again for each value at a constant offset that a branch depends on,
// and corrupts memory if there are more than four in a block.
fn light_at(index: u32) -> Light {
    return lights[select(min(index + view.zero, FEW_LIGHTS - 1u), view.zero, ONLY_ONE)];
}
