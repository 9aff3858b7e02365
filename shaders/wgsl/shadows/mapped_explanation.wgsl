// What shadow map techniques say about a point: the view that it is read from, and the lookup there.
#define_import_path shadowgraph::explanation
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::explained_lookup::{FACTS, LOOKUP_FACTS, NOT_COVERED, lookup_facts}
#import shadowgraph::shadows::filter::filter_radius
#import shadowgraph::shadows::tiles::{blend_at, edge_fade, shadow_fade}
#import shadowgraph::shadows::views::{light_shadow, light_view}

fn explain_shadow(light: u32, receiver: Receiver) -> array<f32, FACTS> {
    var facts: array<f32, FACTS>;
    let shadow = light_shadow(light);
    if shadow.view_count == 0u {
        return facts;
    }
    let blend = blend_at(shadow, receiver);
    if !blend.first.covered {
        facts[0] = NOT_COVERED;
        return facts;
    }
    let lookup = blend.first;
    let tile = light_view(shadow, lookup.view);
    let strength = shadow_fade(shadow, receiver) * edge_fade(shadow, receiver, lookup);
    let radius = filter_radius(shadow, receiver, lookup);
    facts = lookup_facts(tile, shadow, receiver, lookup, radius, blend.weight, strength);
    facts[LOOKUP_FACTS] = f32(shadow.map);
    facts[LOOKUP_FACTS + 1u] = f32(lookup.view);
    let corner = LOOKUP_FACTS + 2u;
    facts[corner] = f32(tile.tile_px.x);
    facts[corner + 1u] = f32(tile.tile_px.y);
    facts[corner + 2u] = f32(tile.tile_px.z);
    facts[corner + 3u] = f32(tile.tile_px.w);
    return facts;
}
