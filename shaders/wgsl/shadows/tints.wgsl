// The tint of light that reaches a point through translucent casters: a colour map next to the depth map, as in Filion and
// McNaughton, "StarCraft II: Effects & Techniques" (SIGGRAPH 2008).
#define_import_path shadowgraph::shadows::tints
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{map_size, stored_depth, stored_tint, stored_tint_depth}
#import shadowgraph::shadows::tent::{tent_depth, tent_integral}
#import shadowgraph::shadows::types::ShadowLight

// The transmittance, 0 to 1 each: the mean over the texels around the point that are not blocked. Blocked texels are left to the
// filter.
fn tint(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> vec3f {
    // As wide as the filter of `pcf`.
    let taps = i32(light.filter_taps);
    let half = max(light.filter_half - light.filter_falloff * receiver.view_depth, 0.5);
    let at = lookup.uv * map_size(light.map);
    let first = floor(at - 0.5);
    let s = at - 0.5 - first;
    let slope = lookup.plane.slope;
    var unblocked_weight = 0.0;
    var transmitted = vec3f(0.0);
    for (var y = 1 - taps; y <= taps; y++) {
        let down = f32(y) - s.y;
        let height = tent_integral(down + 0.5, half) - tent_integral(down - 0.5, half);
        for (var x = 1 - taps; x <= taps; x++) {
            let across = f32(x) - s.x;
            let weight = height * (tent_integral(across + 0.5, half) - tent_integral(across - 0.5, half));
            let texel = vec2i(first) + vec2i(x, y);
            let from_point = vec2f(across, down);
            let depth = tent_depth(lookup.plane, dot(slope, from_point), from_point);
            if depth < stored_depth(light.map, texel) {
                continue;
            }
            unblocked_weight += weight;
            if depth < stored_tint_depth(light.map, texel) {
                transmitted += weight * stored_tint(light.map, texel);
            } else {
                transmitted += weight;
            }
        }
    }
    return select(vec3f(1.0), transmitted / max(unblocked_weight, 1e-6), unblocked_weight > 0.0);
}
