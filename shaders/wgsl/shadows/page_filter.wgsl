// The width of the filter of virtual shadow maps: that of the settings, in texels of the level that a point is read from, and narrower where
// penumbrae are.
#define_import_path shadowgraph::shadows::page_filter
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::filter::shadow_sampler
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{compared_in, map_size, stored_depth}
#import shadowgraph::shadows::page_blockers::{TENT_OF_DISC, penumbra, penumbra_at, spiral}
#import shadowgraph::shadows::page_lookup::{Found, projections}
#import shadowgraph::shadows::pages::Softness
#import shadowgraph::shadows::tent::tent_depth
#import shadowgraph::shadows::types::ShadowLight

// Shadows narrower than a pixel fall between the texels of narrower filters.
const NARROWEST_HALF: f32 = 2.5;
const SEARCH_TAPS: u32 = 8u;

// `level`: the one whose texels are as wide as the pixel asks for.
fn softness(projection_index: u32, shadow: ShadowLight, receiver: Receiver, level: f32) -> Softness {
    return Softness(level, 0.0);
}

// The half width of the filter at a point, texels: that of the settings, or of the penumbrae of the blockers within it, where they are narrower.
fn half_width(light: ShadowLight, soft: Softness, lookup: Lookup, found: Found) -> f32 {
    let projection = projections[found.page.projection];
    var blockers = 0.0;
    var sum = 0.0;
    for (var i = 0u; i < SEARCH_TAPS; i++) {
        let radius = penumbra_at(light, projection, found.page.level, lookup, light.filter_half * spiral(i, SEARCH_TAPS, 0.0));
        if radius >= 0.0 {
            blockers += 1.0;
            sum += radius;
        }
    }
    if blockers == 0.0 {
        return light.filter_half;
    }
    let half = TENT_OF_DISC * ldexp(sum / blockers, -i32(found.page.level));
    return min(max(half, NARROWEST_HALF), light.filter_half);
}

// The visibility near a contact. The filter is wider than the penumbra of a near blocker, and would light what is in its shadow: thin casters
// would lose theirs. Where the nearest texels have a blocker whose penumbra has no width, their comparison alone decides; towards a half width
// of a texel, less and less.
fn near_contact(light: ShadowLight, lookup: Lookup, found: Found, visibility: f32) -> f32 {
    let from_centre = lookup.uv * map_size(light.map) - 0.5;
    let first = floor(from_centre);
    let at = from_centre - first;
    let slope = lookup.plane.slope;
    let rise = max(-at * slope, (1.0 - at) * slope);
    let depth = tent_depth(lookup.plane, rise.x + rise.y, vec2f(0.0));
    let narrow = compared_in(light.map, shadow_sampler, lookup.uv, depth);
    if narrow >= visibility {
        return visibility;
    }
    var blocker = 0.0;
    for (var i = 0u; i < 4u; i++) {
        blocker = max(blocker, stored_depth(light.map, vec2i(first) + vec2i(i32(i & 1u), i32(i >> 1u))));
    }
    let radius = penumbra(projections[found.page.projection], found.page.level, lookup, blocker);
    let half = TENT_OF_DISC * ldexp(radius, -i32(found.page.level));
    return mix(visibility, narrow, saturate(1.0 - half));
}
