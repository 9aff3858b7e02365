// Penumbrae in virtual shadow maps, after Fernando, "Percentage-Closer Soft Shadows" (2005): their width follows from the light's size and the
// distance of the blockers. Blockers are searched around the point in finer and then coarser levels, always some texels far, and penumbrae are
// filtered in the level where they are some texels wide. It replaces the built-in module of filters of constant width.
#define_import_path shadowgraph::shadows::page_filter
#import shadowgraph::receiver::{Receiver, receiver_noise}
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::page_blockers::{TENT_OF_DISC, penumbra_at, spiral}
#import shadowgraph::shadows::page_lookup::{Found, find_page, look_up_page, projections}
#import shadowgraph::shadows::pages::{Projection, Softness, project}
#import shadowgraph::shadows::types::ShadowLight

// The largest half width of the tent, texels: the border of a page is a texel wider. Penumbrae are at least half as wide in the level that they
// are read from.
const MAX_HALF: f32 = 3.0;
const LEAST_HALF: f32 = 1.0;
// The same for a search.
const SEARCH_TEXELS: f32 = 3.0;
const SEARCH_TAPS: u32 = 16u;
// Levels from one search to the next.
const SEARCH_STEP: u32 = 2u;
const TAU: f32 = 6.28318531;

// The mean radius of the penumbrae, texels of level 0, of the blockers within some texels of a point that darken it: it is nearer to them than
// the radius of their penumbra. 0 without any.
fn blocker_penumbra(shadow: ShadowLight, projection: Projection, number: u32, lookup: Lookup, rotation: f32) -> f32 {
    let texel = exp2(f32(number));
    var blockers = 0.0;
    var sum = 0.0;
    var i = 0u;
    loop {
        let tap = SEARCH_TEXELS * spiral(i, SEARCH_TAPS, rotation);
        let radius = penumbra_at(shadow, projection, number, lookup, tap);
        // A texel is as wide as it is far.
        if radius >= max((length(tap) - 1.0) * texel, 0.0) {
            blockers += 1.0;
            sum += radius;
        }
        i++;
        if i == SEARCH_TAPS {
            break;
        }
    }
    return sum / max(blockers, 1.0);
}

// `level`: the one whose texels are as wide as the pixel asks for.
fn softness(projection_index: u32, shadow: ShadowLight, receiver: Receiver, level: f32) -> Softness {
    let projection = projections[projection_index];
    let w = max(project(projection, receiver.position).w, 1e-6);
    let widest = projection.max_radius_m / (projection.texel_m * w);
    let rotation = TAU * receiver_noise(receiver);
    let last = projection.level_count - 1u;
    var radius = 0.0;
    var number = u32(level);
    loop {
        let found = find_page(projection_index, shadow, receiver, number);
        let lookup = look_up_page(shadow, receiver, found);
        if !lookup.covered {
            break;
        }
        number = found.page.level;
        radius = blocker_penumbra(shadow, projection, number, lookup, rotation);
        if radius > 0.0 || number == last || ldexp(SEARCH_TEXELS, i32(number)) >= widest {
            break;
        }
        number = min(number + SEARCH_STEP, last);
    }
    // At least as wide as the filter of the settings in the level that the pixel asks for.
    radius = max(TENT_OF_DISC * min(radius, widest), shadow.filter_half * exp2(floor(level)));
    let wide = log2(radius * 2.0 / MAX_HALF);
    return Softness(clamp(wide, level, max(level, f32(last))), radius);
}

// The half width of the filter in a level, texels.
fn half_width(light: ShadowLight, soft: Softness, lookup: Lookup, found: Found) -> f32 {
    return clamp(ldexp(soft.radius, -i32(found.page.level)), LEAST_HALF, MAX_HALF);
}

// The visibility near a contact: that of a filter whose width follows from the blockers is right there.
fn near_contact(light: ShadowLight, lookup: Lookup, found: Found, visibility: f32) -> f32 {
    return visibility;
}
