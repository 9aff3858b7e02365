// The shadow views and lights of a frame with few of them, in uniform blocks: in fragment shaders Mesa's software driver reads storage
// buffers pixel by pixel.
#define_import_path shadowgraph::shadows::views
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}
#import shadowgraph::shadows::variant::ONE_LIGHT

const FEW_VIEWS: u32 = 32u;
const FEW_LIGHTS: u32 = 32u;

@group(1) @binding(8) var<uniform> few_views: array<ShadowView, FEW_VIEWS>;
@group(1) @binding(9) var<uniform> few_lights: array<ShadowLight, FEW_LIGHTS>;

// The shadows of a light of the scene. The index is never constant: Mesa's software driver compiles a shader again for each value at a
// constant offset that a branch depends on, and corrupts memory if there are more than four in a block.
fn light_shadow(light: u32) -> ShadowLight {
    let zero = few_lights[0].zero;
    var shadow = few_lights[select(min(light + zero, FEW_LIGHTS - 1u), zero, ONE_LIGHT)];
    if light >= select(FEW_LIGHTS, 1u, ONE_LIGHT) {
        shadow.view_count = 0u;
    }
    return shadow;
}

// A view of a light, by its index among those of the light.
fn light_view(light: ShadowLight, index: u32) -> ShadowView {
    return few_views[light.first_view + index];
}
