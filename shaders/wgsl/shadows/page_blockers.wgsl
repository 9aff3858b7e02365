// How far the penumbra of a blocker in a page extends.
#define_import_path shadowgraph::shadows::page_blockers
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::page_lookup::levels
#import shadowgraph::shadows::pages::Projection
#import shadowgraph::shadows::variant::DIRECTIONAL

// The half width of the tent whose variance is that of a light's disc of radius 1 behind a straight edge: sqrt(6) / 2.
const TENT_OF_DISC: f32 = 1.2247449;

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
