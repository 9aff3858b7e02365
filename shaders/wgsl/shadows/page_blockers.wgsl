// The blockers around a point in a page, and how far their penumbrae extend.
#define_import_path shadowgraph::shadows::page_blockers
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{map_size, stored_depth}
#import shadowgraph::shadows::page_lookup::levels
#import shadowgraph::shadows::pages::Projection
#import shadowgraph::shadows::tent::tent_depth
#import shadowgraph::shadows::types::ShadowLight
#import shadowgraph::shadows::variant::DIRECTIONAL

// The half width of the tent whose variance is that of a light's disc of radius 1 behind a straight edge: sqrt(6) / 2.
const TENT_OF_DISC: f32 = 1.2247449;
const GOLDEN_ANGLE: f32 = 2.39996323;

// One of `taps` points that fill the unit disc evenly.
fn spiral(tap: u32, taps: u32, rotation: f32) -> vec2f {
    let angle = f32(tap) * GOLDEN_ANGLE + rotation;
    return sqrt((f32(tap) + 0.5) / f32(taps)) * vec2f(cos(angle), sin(angle));
}

// The radius of the penumbra of a blocker, texels of level 0, in a page of a level.
fn penumbra(projection: Projection, number: u32, lookup: Lookup, blocker: f32) -> f32 {
    let level = levels[projection.first_level + number];
    // Depths change by this over a texel of level 0 towards the light, at w = 1.
    let per_texel = projection.depth_per_texel * level.depth_scale;
    if DIRECTIONAL || projection.is_perspective == 0u {
        return projection.light_radius * (blocker - lookup.depth) / per_texel;
    }
    // Depth is a + b / w.
    let b = per_texel / projection.texel_m;
    let a = lookup.depth - b / lookup.w;
    let blocker_w = b / max(blocker - a, 1e-9);
    return projection.light_radius * max(lookup.w - blocker_w, 0.0) / (blocker_w * lookup.w * projection.texel_m);
}

// The radius of the penumbra, texels of level 0, of the blocker that is `tap` texels from a point; -1 without one.
fn penumbra_at(shadow: ShadowLight, projection: Projection, number: u32, lookup: Lookup, tap: vec2f) -> f32 {
    let slope = lookup.plane.slope;
    let rise = abs(dot(slope, tap)) + 0.5 * (abs(slope.x) + abs(slope.y));
    let stored = stored_depth(shadow.map, vec2i(floor(lookup.uv * map_size(shadow.map) + tap)));
    if stored <= tent_depth(lookup.plane, rise, tap) {
        return -1.0;
    }
    return penumbra(projection, number, lookup, stored);
}
