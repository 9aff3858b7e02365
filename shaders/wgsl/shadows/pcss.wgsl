// The filter of the technique `pcss`: penumbrae with a width that follows from the light's size (Fernando, "Percentage-Closer Soft
// Shadows", 2005). Taps lie on a Vogel spiral that is rotated per pixel.
#define_import_path shadowgraph::shadows::filter
#import shadowgraph::receiver::{Receiver, receiver_noise}
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{cascade_map, atlas_map, is_cascade_map, map_size, stored_depth}
#import shadowgraph::shadows::tent::tent_depth
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}
#import shadowgraph::shadows::views::light_view

// The settings, and what follows from them.
struct Pcss {
    sun_radius_rad: f32,
    light_radius_m: f32,
    max_radius_texels: f32,
    blocker_taps: u32,
    filter_taps: u32,
    // The tangent of sun_radius_rad.
    sun_tangent: f32,
}

// Linear, GreaterEqual: a point is lit if it is at least as near to the light as the stored depth.
@group(1) @binding(10) var shadow_sampler: sampler_comparison;
@group(1) @binding(11) var<uniform> pcss: Pcss;

const GOLDEN_ANGLE: f32 = 2.39996323;
const TAU: f32 = 6.28318531;
// The least filter radius: an edge in a map is never sharper than its texels.
const MIN_TEXELS: f32 = 0.7;

// A point in the unit disc.
fn spiral(tap: u32, count: u32, rotation: f32) -> vec2f {
    let angle = f32(tap) * GOLDEN_ANGLE + rotation;
    return sqrt((f32(tap) + 0.5) / f32(count)) * vec2f(cos(angle), sin(angle));
}

// Distance from a spot or point light along the tile's axis, metres.
fn axis_distance(shadow_view: ShadowView, depth: f32) -> f32 {
    let far = shadow_view.near_m + shadow_view.depth_range_m;
    return shadow_view.near_m * far / (shadow_view.near_m + depth * shadow_view.depth_range_m);
}

// The half width of the penumbra, in units of the longer side of a texel, for a blocker at this depth.
fn penumbra_texels(shadow_view: ShadowView, point: f32, blocker: f32) -> f32 {
    if shadow_view.light.w == 0.0 {
        let distance_m = (blocker - point) * shadow_view.depth_range_m;
        return pcss.sun_tangent * distance_m / shadow_view.texel_world;
    }
    let near_m = axis_distance(shadow_view, blocker);
    let far_m = axis_distance(shadow_view, point);
    return pcss.light_radius_m * (far_m - near_m) / (near_m * far_m * shadow_view.texel_world);
}

// The reference depth of a tap at an offset in texels: the nearest of the texels that it reads.
fn tap_depth(lookup: Lookup, tap: vec2f) -> f32 {
    let slope = lookup.plane.slope;
    return tent_depth(lookup.plane, abs(dot(slope, tap)) + 0.5 * (abs(slope.x) + abs(slope.y)), tap);
}

// The radius of the filter where blockers are near, texels of the depth map.
fn filter_radius(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    return pcss.max_radius_texels;
}

// The radii of a disc along both axes, texels, that is as wide as the penumbra in both.
fn radii(shadow_view: ShadowView, penumbra: f32, least: f32) -> vec2f {
    return min(max(penumbra / shadow_view.texel_scale, vec2f(least)), vec2f(pcss.max_radius_texels));
}

// The visibility of the light from a point: 0 (in shadow) to 1.
fn filtered(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    let in_cascades = is_cascade_map(light.map);
    let shadow_view = light_view(light, lookup.view);
    let size_px = map_size(light.map);
    let at = lookup.uv * size_px;
    let rotation = TAU * (receiver_noise(receiver) + lookup.turn);

    // Blocker search: the mean depth of the blockers.
    let widest = radii(shadow_view, penumbra_texels(shadow_view, lookup.plane.depth, 1.0), 1.0);
    var blockers = 0.0;
    var depths = 0.0;
    var i = 0u;
    loop {
        let tap = widest * spiral(i, pcss.blocker_taps, rotation);
        let stored = stored_depth(light.map, vec2i(floor(at + tap)));
        if stored > tap_depth(lookup, tap) {
            blockers += 1.0;
            depths += stored;
        }
        i++;
        if i >= pcss.blocker_taps {
            break;
        }
    }
    if blockers == 0.0 {
        return 1.0;
    }

    let penumbra = penumbra_texels(shadow_view, lookup.plane.depth, depths / blockers);
    let radius = radii(shadow_view, penumbra, max(MIN_TEXELS, lookup.min_radius));
    var visibility = 0.0;
    i = 0u;
    loop {
        let tap = radius * spiral(i, pcss.filter_taps, rotation);
        let uv = (at + tap) / size_px;
        let depth = tap_depth(lookup, tap);
        if in_cascades {
            visibility += textureSampleCompareLevel(cascade_map, shadow_sampler, uv, depth);
        } else {
            visibility += textureSampleCompareLevel(atlas_map, shadow_sampler, uv, depth);
        }
        i++;
        if i >= pcss.filter_taps {
            break;
        }
    }
    return visibility / f32(pcss.filter_taps);
}
