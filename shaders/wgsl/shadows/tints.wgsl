// The colour of the light that gets to a point through translucent casters: a map of colours beside that of depths, as in Filion and
// McNaughton, "StarCraft II: Effects & Techniques" (SIGGRAPH 2008).
#define_import_path shadowgraph::shadows::tints
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{map_size, stored_depth, stored_tint, stored_tint_depth}
#import shadowgraph::shadows::tent::{tent_depth, tent_integral}
#import shadowgraph::shadows::tiles::shadow_views
#import shadowgraph::shadows::types::ShadowLight

// What of the light is left, 0 to 1 each: the mean over the texels around the point from which light does get there. Those that are
// blocked are the filter's affair.
fn tint(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> vec3f {
    if shadow_views[light.first_view + lookup.view].is_tinted == 0u {
        return vec3f(1.0);
    }
    // As wide as the filter of `pcf`.
    let taps = i32(light.filter_taps);
    let half = max(light.filter_half - light.filter_falloff * receiver.view_depth, 0.5);
    let at = lookup.uv * map_size(light.map);
    let first = floor(at - 0.5);
    let s = at - 0.5 - first;
    let slope = lookup.plane.slope;
    var lit = 0.0;
    var passed = vec3f(0.0);
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
            lit += weight;
            if depth < stored_tint_depth(light.map, texel) {
                passed += weight * stored_tint(light.map, texel);
            } else {
                passed += weight;
            }
        }
    }
    return select(vec3f(1.0), passed / max(lit, 1e-6), lit > 0.0);
}
