// Shadow map techniques: finds the tiles of a point and evaluates the technique's filter there. The filter is the module
// shadowgraph::shadows::filter; its bindings start at 8.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::crease::is_behind_crease
#import shadowgraph::shadows::filter::{filtered, filter_radius}
#import shadowgraph::shadows::footprint::{SAMPLES, footprint_of, sampled}
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::tints::tint
#import shadowgraph::shadows::colors::cascade_tint
#import shadowgraph::shadows::tiles::{shadow_views, shadow_lights, blend_at, shadow_fade, edge_fade}
#import shadowgraph::shadows::types::ShadowLight
#import shadowgraph::shadows::variant::{SHADOWED, SIMPLE}

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    if !SHADOWED || light >= arrayLength(&shadow_lights) {
        return vec3f(1.0);
    }
    let shadow = shadow_lights[light];
    let strength = shadow_fade(shadow, receiver);
    if shadow.view_count == 0u || strength <= 0.0 {
        return vec3f(1.0);
    }
    let blend = blend_at(shadow, receiver);
    if !blend.first.covered {
        return vec3f(1.0);
    }
    var visibility = vec3f(0.0);
    var lookup = blend.first;
    var weight = blend.weight;
    if !SIMPLE && weight <= 0.0 {
        lookup = blend.next;
        weight = 1.0;
    }
    let count = select(2u, 1u, SIMPLE);
    for (var i = 0u; i < count && weight > 0.0; i++) {
        visibility += weight * pixel_visibility(shadow, receiver, lookup);
        lookup = blend.next;
        weight = 1.0 - weight;
    }
    return mix(vec3f(1.0), visibility, strength * edge_fade(shadow, receiver, blend.first));
}

// The visibility in one view: at a receiver, or the mean over its pixel where that is wider than texels.
fn pixel_visibility(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> vec3f {
    let shadow_view = shadow_views[light.first_view + lookup.view];
    let footprint = footprint_of(shadow_view, light, receiver, lookup);
    // One loop for both: drivers inline each call of a filter.
    let samples = select(1u, SAMPLES, footprint.spread > 0.0);
    var sum = vec3f(0.0);
    for (var i = 0u; i < samples; i++) {
        let moved = sampled(shadow_view, light, lookup, footprint, i);
        sum += filtered(light, receiver, moved) * tint(light, receiver, moved);
    }
    if any(sum > vec3f(0.0)) && is_behind_crease(light, lookup, filter_radius(light, receiver, lookup)) {
        return vec3f(0.0);
    }
    return sum / f32(samples);
}

// The colour of the cascade that is read, paler where shadows fade, blended where cascades blend; violet in the atlas; white
// without shadows.
fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    if light >= arrayLength(&shadow_lights) || shadow_lights[light].view_count == 0u {
        return vec3f(1.0);
    }
    let shadow = shadow_lights[light];
    let blend = blend_at(shadow, receiver);
    if !blend.first.covered {
        return vec3f(1.0);
    }
    let color = mix(view_tint(shadow, blend.next), view_tint(shadow, blend.first), blend.weight);
    let fade = shadow_fade(shadow, receiver) * edge_fade(shadow, receiver, blend.first);
    return mix(vec3f(1.0), color, fade);
}

fn view_tint(light: ShadowLight, lookup: Lookup) -> vec3f {
    return cascade_tint(shadow_views[light.first_view + lookup.view].cascade);
}
