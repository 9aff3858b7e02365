// The technique `virtual`: shadows from pages of virtual shadow maps. A point is read from the level whose texels are at most as wide as its
// pixel, or from the next coarser one with a page there.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::{Receiver, RECEIVER_COARSER}
#import shadowgraph::shadows::colors::cascade_tint
#import shadowgraph::shadows::cube::cube_face
#import shadowgraph::shadows::crease::is_behind_crease
#import shadowgraph::shadows::filter::filtered
#import shadowgraph::shadows::page_lookup::{
    Found, find_page, levels, light_shadow, look_up_page, page_table, projections,
}
#import shadowgraph::shadows::page_filter::{half_width, near_contact, softness}
#import shadowgraph::shadows::pages::{
    BLEND_PART, COARSENING_STEPS, Softness, direction_to_light, narrowing, project, wanted_level,
}
#import shadowgraph::shadows::tints::tint
#import shadowgraph::shadows::types::ShadowLight
#import shadowgraph::shadows::variant::{DIRECTIONAL, TINTED}
#import shadowgraph::view::{direction_to_camera, pixels_per_metre, view}

// Lit where there is no page.
fn page_visibility(shadow: ShadowLight, receiver: Receiver, soft: Softness, found: Found) -> vec3f {
    let lookup = look_up_page(shadow, receiver, found);
    if !lookup.covered {
        return vec3f(1.0);
    }
    var light = shadow;
    light.filter_half = half_width(shadow, soft, lookup, found);
    var visibility = filtered(light, receiver, lookup);
    if visibility > 0.0 {
        if is_behind_crease(light, lookup, light.filter_half) {
            return vec3f(0.0);
        }
        visibility = near_contact(light, lookup, found, visibility);
    }
    if TINTED {
        return visibility * tint(light, receiver, lookup);
    }
    return vec3f(visibility);
}

// The level that a point is read from; the fraction says how near it is to the next one.
fn level_at(index: u32, receiver: Receiver) -> f32 {
    let projection = projections[index];
    let to_camera = direction_to_camera(receiver.position - view.position);
    let to_light = direction_to_light(projection, receiver.position);
    let finer = narrowing(receiver.geometric_normal, to_camera, to_light);
    let pixel_m = exp2(page_table.level_bias + finer) / pixels_per_metre(receiver.view_depth);
    let wanted = wanted_level(projection, project(projection, receiver.position), pixel_m)
        + f32(page_table.coarsening) / COARSENING_STEPS
        + select(0.0, 1.0, (receiver.flags & RECEIVER_COARSER) != 0u);
    return min(wanted, f32(projection.level_count - 1u));
}

// The index of the projection of a point.
fn projection_of(shadow: ShadowLight, receiver: Receiver) -> u32 {
    if DIRECTIONAL || shadow.view_count == 1u {
        return shadow.first_view;
    }
    return shadow.first_view + cube_face(receiver.position - projections[shadow.first_view].center);
}

fn strength_at(shadow: ShadowLight, receiver: Receiver) -> f32 {
    let distance_m = select(receiver.view_depth, distance(shadow.eye, receiver.position), shadow.fades_by_radius == 1u);
    return shadow.strength * saturate((shadow.fade_end_m - distance_m) * shadow.fade_per_m);
}

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    let shadow = light_shadow(light);
    let strength = strength_at(shadow, receiver);
    if shadow.view_count == 0u || strength <= 0.0 {
        return vec3f(1.0);
    }
    let index = projection_of(shadow, receiver);
    let soft = softness(index, shadow, receiver, level_at(index, receiver));
    let wanted = soft.level;
    let finest = u32(wanted);
    var found = find_page(index, shadow, receiver, finest);
    // Near the end of its range, a level is blended with the next.
    let blends = found.exists && found.page.level == finest;
    var weight = 1.0 - select(0.0, saturate((fract(wanted) - (1.0 - BLEND_PART)) / BLEND_PART), blends);
    var visibility = vec3f(0.0);
    var is_last = weight == 1.0;
    loop {
        visibility += weight * page_visibility(shadow, receiver, soft, found);
        if is_last {
            break;
        }
        found = find_page(index, shadow, receiver, finest + 1u);
        weight = 1.0 - weight;
        is_last = true;
    }
    return mix(vec3f(1.0), visibility, strength);
}

// The colour of the level that is read, in a checkerboard of its pages; darker where the page is kept from an earlier frame. White without
// shadows.
fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    let shadow = light_shadow(light);
    let strength = strength_at(shadow, receiver);
    if shadow.view_count == 0u || strength <= 0.0 {
        return vec3f(1.0);
    }
    let index = projection_of(shadow, receiver);
    let found = find_page(index, shadow, receiver, u32(level_at(index, receiver)));
    if !found.exists {
        return vec3f(1.0);
    }
    let is_odd = ((found.page.place.x + found.page.place.y) & 1) == 1;
    let exponent = levels[projections[index].first_level + found.page.level].exponent;
    return cascade_tint(u32(exponent & 3)) * select(1.0, 0.75, is_odd) * select(0.45, 1.0, found.is_drawn);
}
