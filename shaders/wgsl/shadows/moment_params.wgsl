// What users choose of shadow maps of moments.
#define_import_path shadowgraph::shadows::moment_params
#import shadowgraph::shadows::types::ShadowView

// 32 bytes.
struct MomentParams {
    // By how much depths are warped towards the light and away from it; 0 without a warp.
    exponents: vec2f,
    // The part of the light behind a blocker that is taken for light that leaks there.
    bleed: f32,
    // How far apart depths count as one, in parts of the tile's range, or how far moments are moved to those of any depth.
    bias: f32,
    // How many texels of the map of depths a texel of moments stands for along each axis.
    downscale: u32,
    // How many texels of moments are blurred over to either side.
    radius: u32,
    mips: u32,
}

// From a depth of a map (1 nearest to the light) to parts of the way through the tile's range: 0 nearest, 1 farthest.
fn linear_depth(shadow_view: ShadowView, depth: f32) -> f32 {
    if shadow_view.light.w == 0.0 {
        return 1.0 - depth;
    }
    let near = shadow_view.near_m;
    let range = shadow_view.depth_range_m;
    let distance = near * (near + range) / (near + depth * range);
    return (distance - near) / range;
}
