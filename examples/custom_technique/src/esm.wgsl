#define_import_path shadowgraph::shadows::filter
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{map_size, stored_depth}
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}
#import shadowgraph::shadows::views::light_view

struct Falloff {
    per_metre: f32,
}

@group(1) @binding(10) var<uniform> falloff: Falloff;

// Distance from the near end of the tile's depth range, metres; depth is reversed, 1 at the light.
fn metres(shadow_view: ShadowView, depth: f32) -> f32 {
    if shadow_view.light.w == 0.0 {
        return (1.0 - depth) * shadow_view.depth_range_m;
    }
    let far = shadow_view.near_m + shadow_view.depth_range_m;
    return shadow_view.near_m * far / (shadow_view.near_m + depth * shadow_view.depth_range_m);
}

// The radius of the filter, texels.
fn filter_radius(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    return 1.0;
}

// Visibility of a point: 0 to 1.
fn filtered(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    let shadow_view = light_view(light, lookup.view);
    let point = metres(shadow_view, lookup.plane.depth);
    let texel = lookup.uv * map_size(light.map) - 0.5;
    let fraction = fract(texel);
    var visibility = 0.0;
    for (var i = 0u; i < 4u; i++) {
        let corner = vec2u(i & 1u, i >> 1u);
        let stored = stored_depth(light.map, vec2i(floor(texel)) + vec2i(corner));
        let behind = max(point - metres(shadow_view, stored), 0.0);
        let weight = select(1.0 - fraction, fraction, corner == vec2u(1u));
        visibility += weight.x * weight.y * exp(-behind * falloff.per_metre);
    }
    return visibility;
}
