// Depth for techniques with moment maps.
#define_import_path shadowgraph::shadows::linear_depth
#import shadowgraph::shadows::types::ShadowView

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
