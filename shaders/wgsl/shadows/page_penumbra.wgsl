// Penumbrae in virtual shadow maps, after Fernando, "Percentage-Closer Soft Shadows" (2005): their width follows from the light's size and the
// distance of the blockers. Blockers are searched, and penumbrae filtered, in the level where they are some texels wide. It replaces the
// built-in module of filters of constant width.
#define_import_path shadowgraph::shadows::page_filter
#import shadowgraph::receiver::{Receiver, receiver_noise}
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{map_size, stored_depth}
#import shadowgraph::shadows::page_lookup::{Found, find_page, levels, look_up_page, projections}
#import shadowgraph::shadows::pages::{Projection, project}
#import shadowgraph::shadows::tent::tent_depth
#import shadowgraph::shadows::types::ShadowLight

// The largest half width of the tent, texels: the border of a page is a texel wider.
const MAX_HALF: f32 = 3.0;
// The same for the search.
const SEARCH_TEXELS: f32 = 3.0;
const SEARCH_TAPS: u32 = 16u;
// The half width of the tent whose variance is that of a light's disc of radius 1 behind a straight edge: sqrt(6) / 2.
const TENT_OF_DISC: f32 = 1.2247449;
// Searches, each within the radius that the one before has found.
const SEARCHES: u32 = 2u;
const GOLDEN_ANGLE: f32 = 2.39996323;
const TAU: f32 = 6.28318531;

// How soft the shadows of a point are.
struct Softness {
    // The level that it is read from; the fraction says how near it is to the next one.
    level: f32,
    // The radius of the filter, texels of level 0; the filter of the settings is the least.
    radius: f32,
}

// A point in the unit disc.
fn spiral(tap: u32, rotation: f32) -> vec2f {
    let angle = f32(tap) * GOLDEN_ANGLE + rotation;
    return sqrt((f32(tap) + 0.5) / f32(SEARCH_TAPS)) * vec2f(cos(angle), sin(angle));
}

// The mean depth of the blockers within a radius, texels of the page; 0 without any.
fn blocker_depth(shadow: ShadowLight, lookup: Lookup, radius: f32, rotation: f32) -> f32 {
    let at = lookup.uv * map_size(shadow.map);
    let slope = lookup.plane.slope;
    var blockers = 0.0;
    var depths = 0.0;
    var i = 0u;
    loop {
        let tap = radius * spiral(i, rotation);
        let rise = abs(dot(slope, tap)) + 0.5 * (abs(slope.x) + abs(slope.y));
        let stored = stored_depth(shadow.map, vec2i(floor(at + tap)));
        if stored > tent_depth(lookup.plane, rise, tap) {
            blockers += 1.0;
            depths += stored;
        }
        i++;
        if i == SEARCH_TAPS {
            break;
        }
    }
    return depths / max(blockers, 1.0);
}

// The radius of the penumbra of a blocker, texels of level 0, in a page of a level.
fn penumbra(projection: Projection, number: u32, lookup: Lookup, blocker: f32) -> f32 {
    let level = levels[projection.first_level + number];
    // Depths change by this over a texel of level 0 towards the light, at w = 1.
    let per_texel = projection.depth_per_texel * level.depth_scale;
    if projection.is_perspective == 0u {
        return projection.light_radius * (blocker - lookup.depth) / per_texel;
    }
    // Depth is a + b / w.
    let b = per_texel / projection.texel_m;
    let a = lookup.depth - b / lookup.w;
    let blocker_w = b / max(blocker - a, 1e-9);
    return projection.light_radius * max(lookup.w - blocker_w, 0.0) / (blocker_w * lookup.w * projection.texel_m);
}

// `level`: the one whose texels are as wide as the pixel asks for.
fn softness(projection_index: u32, shadow: ShadowLight, receiver: Receiver, level: f32) -> Softness {
    let projection = projections[projection_index];
    let w = max(project(projection, receiver.position).w, 1e-6);
    let widest = projection.max_radius_m / (projection.texel_m * w);
    let rotation = TAU * receiver_noise(receiver);
    var radius = widest;
    var search = 0u;
    loop {
        let number = max(ceil(log2(max(radius, 1e-6) / SEARCH_TEXELS)), floor(level));
        let found = find_page(projection_index, shadow, receiver, u32(clamp(number, 0.0, f32(projection.level_count - 1u))));
        let lookup = look_up_page(shadow, receiver, found);
        if !lookup.covered {
            break;
        }
        let found_number = found.page.level;
        let searched = clamp(ldexp(radius, -i32(found_number)), 1.0, SEARCH_TEXELS);
        let blocker = blocker_depth(shadow, lookup, searched, rotation);
        if blocker == 0.0 {
            radius = 0.0;
            break;
        }
        radius = clamp(penumbra(projection, found_number, lookup, blocker), 0.0, widest);
        search++;
        if search == SEARCHES {
            break;
        }
    }
    radius *= TENT_OF_DISC;
    let wide = log2(max(radius, 1e-6) * 2.0 / MAX_HALF);
    return Softness(clamp(wide, level, max(level, f32(projection.level_count - 1u))), radius);
}
