// What virtual shadow maps say about a point: the page that it is read from, and the lookup there.
#define_import_path shadowgraph::explanation
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::explained_lookup::{FACTS, LOOKUP_FACTS, NOT_COVERED, lookup_facts}
#import shadowgraph::shadows::page_filter::{half_width, softness}
#import shadowgraph::shadows::page_lookup::{find_page, light_shadow, look_up_page, page_table, view_of}
#import shadowgraph::shadows::pages::COARSENING_STEPS
#import shadowgraph::technique::{level_at, projection_of, strength_at}

fn explain_shadow(light: u32, receiver: Receiver) -> array<f32, FACTS> {
    var facts: array<f32, FACTS>;
    let shadow = light_shadow(light);
    if shadow.view_count == 0u {
        return facts;
    }
    let index = projection_of(shadow, receiver);
    let soft = softness(index, shadow, receiver, level_at(index, receiver));
    let found = find_page(index, shadow, receiver, u32(soft.level));
    let lookup = look_up_page(shadow, receiver, found);
    if !lookup.covered {
        facts[0] = NOT_COVERED;
        return facts;
    }
    let half = half_width(shadow, soft, lookup, found);
    facts = lookup_facts(view_of(found), shadow, receiver, lookup, half, 1.0, strength_at(shadow, receiver));
    facts[LOOKUP_FACTS] = f32(found.page.level);
    facts[LOOKUP_FACTS + 1u] = soft.level;
    facts[LOOKUP_FACTS + 2u] = f32(page_table.coarsening) / COARSENING_STEPS;
    facts[LOOKUP_FACTS + 3u] = f32(index - shadow.first_view);
    let place = LOOKUP_FACTS + 4u;
    facts[place] = f32(found.page.place.x);
    facts[place + 1u] = f32(found.page.place.y);
    facts[place + 2u] = found.place_px.x;
    facts[place + 3u] = found.place_px.y;
    facts[place + 4u] = select(0.0, 1.0, found.is_drawn);
    return facts;
}
