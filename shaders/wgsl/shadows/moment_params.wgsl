// User settings of moment shadow maps.
#define_import_path shadowgraph::shadows::moment_params
#import shadowgraph::shadows::types::ShadowView

// 32 bytes.
struct MomentParams {
    // Exponents of the warps away from the light and towards it; 0 without a warp.
    exponents: vec2f,
    // The fraction of visibility that is treated as light bleeding.
    bleed: f32,
    // The difference of depths that count as equal, as a fraction of the tile's range, or the bias of moments towards valid ones.
    bias: f32,
    // Depth texels per moment texel along each axis.
    downscale: u32,
    // Blur radius in moment texels.
    radius: u32,
    mips: u32,
}

// From a depth of a map (1 nearest to the light) to the linear position in the tile's range: 0 nearest, 1 farthest.
fn linear_depth(shadow_view: ShadowView, depth: f32) -> f32 {
    if shadow_view.light.w == 0.0 {
        return 1.0 - depth;
    }
    let near = shadow_view.near_m;
    let range = shadow_view.depth_range_m;
    let distance = near * (near + range) / (near + depth * range);
    return (distance - near) / range;
}
