// The filter of the technique `pcf`: a tent of comparisons, each with a bias for its position.
#define_import_path shadowgraph::shadows::filter
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{cascade_map, atlas_map, map_size, stored_gradient}
#import shadowgraph::shadows::tent::{tent_axis, tent_depth}
#import shadowgraph::shadows::types::{ShadowLight, MAP_CASCADES, BIAS_GRADIENT}
#import shadowgraph::shadows::variant::FILTER_TAPS

// Linear, GreaterEqual: a point is lit if it is at least as near to the light as the stored depth.
@group(1) @binding(8) var shadow_sampler: sampler_comparison;

// The radius of the filter where blockers are near, texels of the depth map.
fn filter_radius(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    return light.filter_half;
}

// The visibility of the light from a point, the fraction of the filter that is not nearer to the light: 0 (in shadow) to 1.
fn filtered(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    let in_cascades = light.map == MAP_CASCADES;
    var plane = lookup.plane;
    let size_px = map_size(light.map);
    if light.bias_method == BIAS_GRADIENT {
        plane.depth += lookup.gradient_bias * min(stored_gradient(light.map, lookup.uv), lookup.max_gradient);
    }
    let taps = select(FILTER_TAPS, light.filter_taps, FILTER_TAPS == 0u);
    let half = max(light.filter_half - light.filter_falloff * receiver.view_depth, 0.5);
    let at = lookup.uv * size_px;
    // Centre of the texel up and left of the point, and the offset of the point from it.
    let base = floor(at + 0.5) - 0.5;
    let s = at - base;
    let x_axis = tent_axis(taps, half, s.x, plane.slope.x);
    let y_axis = tent_axis(taps, half, s.y, plane.slope.y);
    var visibility = 0.0;
    for (var y = 0u; y < taps; y++) {
        for (var x = 0u; x < taps; x++) {
            let tap = vec2f(x_axis.offset[x], y_axis.offset[y]);
            let uv = (base + tap) / size_px;
            let depth = tent_depth(plane, x_axis.rise[x] + y_axis.rise[y], tap - s);
            var compared = 0.0;
            if in_cascades {
                compared = textureSampleCompareLevel(cascade_map, shadow_sampler, uv, depth);
            } else {
                compared = textureSampleCompareLevel(atlas_map, shadow_sampler, uv, depth);
            }
            visibility += x_axis.weight[x] * y_axis.weight[y] * compared;
        }
    }
    return visibility;
}
