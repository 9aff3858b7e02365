// Shadow map techniques: finds the tiles of a point and evaluates the technique's filter there. The filter is the module
// shadowgraph::shadows::filter; its bindings start at 10.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::crease::is_behind_crease
#import shadowgraph::shadows::filter::{filtered, filter_radius}
#import shadowgraph::shadows::footprint::{SAMPLES, footprint_of, sampled}
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::tints::tint
#import shadowgraph::shadows::colors::cascade_tint
#import shadowgraph::shadows::tiles::{blend_at, shadow_fade, edge_fade}
#import shadowgraph::shadows::types::ShadowLight
#import shadowgraph::shadows::variant::{SHADOWED, SIMPLE, TINTED}
#import shadowgraph::shadows::views::{light_shadow, light_view}

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    if !SHADOWED {
        return vec3f(1.0);
    }
    let shadow = light_shadow(light);
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
    var is_last = SIMPLE || weight >= 1.0;
    if !SIMPLE && weight <= 0.0 {
        lookup = blend.next;
        weight = 1.0;
        is_last = true;
    }
    loop {
        visibility += weight * pixel_visibility(shadow, receiver, lookup);
        if is_last {
            break;
        }
        lookup = blend.next;
        weight = 1.0 - weight;
        is_last = true;
    }
    return mix(vec3f(1.0), visibility, strength * edge_fade(shadow, receiver, blend.first));
}

// The visibility in one view: at a receiver, or the mean over its pixel where that is wider than texels.
fn pixel_visibility(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> vec3f {
    let tile = light_view(light, lookup.view);
    let footprint = footprint_of(tile, light, receiver, lookup);
    // One loop for both: drivers inline each call of a filter.
    let samples = select(1u, SAMPLES, footprint.spread > 0.0);
    var sum = vec3f(0.0);
    var i = 0u;
    loop {
        let moved = sampled(tile, light, lookup, footprint, i);
        var visibility = vec3f(filtered(light, receiver, moved));
        if TINTED && tile.is_tinted == 1u {
            visibility *= tint(light, receiver, moved);
        }
        sum += visibility;
        i++;
        if i >= samples {
            break;
        }
    }
    if any(sum > vec3f(0.0)) && is_behind_crease(light, lookup, filter_radius(light, receiver, lookup)) {
        return vec3f(0.0);
    }
    return sum / f32(samples);
}

// The colour of the cascade that is read, paler where shadows fade, blended where cascades blend; violet in the atlas; white
// without shadows.
fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    let shadow = light_shadow(light);
    if shadow.view_count == 0u {
        return vec3f(1.0);
    }
    let blend = blend_at(shadow, receiver);
    if !blend.first.covered {
        return vec3f(1.0);
    }
    let color = mix(view_tint(shadow, blend.next), view_tint(shadow, blend.first), blend.weight);
    let fade = shadow_fade(shadow, receiver) * edge_fade(shadow, receiver, blend.first);
    return mix(vec3f(1.0), color, fade);
}

fn view_tint(light: ShadowLight, lookup: Lookup) -> vec3f {
    return cascade_tint(light_view(light, lookup.view).cascade);
}
