// The technique `pcf`: cascades for the brightest directional lights, an atlas for the others, read with a tent filter.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::{Receiver, RECEIVER_COARSER}
#import shadowgraph::shadows::lookup::{Lookup, look_up, stored_gradient}
#import shadowgraph::shadows::tent::{tent_axis, tent_depth}
#import shadowgraph::shadows::variant::{FILTER_TAPS, SHADOWED}
#import shadowgraph::shadows::types::{
    ShadowView, ShadowLight, MAP_CASCADES, SELECT_MAP, SELECT_SPHERE, SELECT_DEPTH, SELECT_FACE,
    BLEND_HARD, BLEND_DITHER, BIAS_GRADIENT,
}

@group(1) @binding(0) var<storage, read> shadow_views: array<ShadowView>;
@group(1) @binding(1) var<storage, read> shadow_lights: array<ShadowLight>;
@group(1) @binding(2) var cascade_map: texture_depth_2d;
@group(1) @binding(3) var atlas_map: texture_depth_2d;
// Linear, GreaterEqual: lit where the point is at least as near to the light as what the map has.
@group(1) @binding(4) var shadow_sampler: sampler_comparison;

// +X, -X, +Y, -Y, +Z, -Z.
fn cube_face(way: vec3f) -> u32 {
    let size = abs(way);
    if size.x >= size.y && size.x >= size.z {
        return select(0u, 1u, way.x < 0.0);
    }
    if size.y >= size.z {
        return select(2u, 3u, way.y < 0.0);
    }
    return select(4u, 5u, way.z < 0.0);
}

// Which of the light's views, from `first` on, a point is read from; view_count, the view of nothing, where none is.
fn select_view(light: ShadowLight, receiver: Receiver, first: u32) -> u32 {
    var chosen = light.view_count;
    if light.select == SELECT_FACE {
        return cube_face(receiver.position - shadow_views[light.first_view].light.xyz);
    }
    if light.select == SELECT_SPHERE {
        for (var i = light.view_count; i > first; i--) {
            let shadow_view = shadow_views[light.first_view + i - 1u];
            let offset = receiver.position - shadow_view.center;
            let inside = dot(offset, offset) < shadow_view.radius * shadow_view.radius;
            chosen = select(chosen, i - 1u, inside);
        }
        return chosen;
    }
    // As many views as end before the point.
    chosen = 0u;
    for (var i = 0u; i < light.view_count; i++) {
        chosen += select(0u, 1u, receiver.view_depth >= shadow_views[light.first_view + i].end_m);
    }
    return max(chosen, first);
}

// How the point is looked up in one of the light's views, from `first` on.
fn find(light: ShadowLight, receiver: Receiver, first: u32) -> Lookup {
    var lookup: Lookup;
    var begin = first;
    var end = light.view_count;
    if light.select != SELECT_MAP {
        begin = select_view(light, receiver, first);
        end = begin + 1u;
    }
    // The first that covers the point has the finest texels.
    for (var i = begin; i < end; i++) {
        lookup = look_up(shadow_views[light.first_view + i], light, receiver);
        lookup.view = i;
        if lookup.covered {
            break;
        }
    }
    return lookup;
}

// 1 within a view, falling to 0 over the outer `fraction` of it.
fn inner_part(light: ShadowLight, receiver: Receiver, lookup: Lookup, fraction: f32) -> f32 {
    let shadow_view = shadow_views[light.first_view + lookup.view];
    if light.select == SELECT_SPHERE {
        let offset = receiver.position - shadow_view.center;
        let relative = dot(offset, offset) / (shadow_view.radius * shadow_view.radius);
        return saturate((1.0 - relative) / (1.0 - (1.0 - fraction) * (1.0 - fraction)));
    }
    if light.select == SELECT_DEPTH {
        let length_m = shadow_view.end_m - shadow_view.begin_m;
        return saturate((shadow_view.end_m - receiver.view_depth) / (fraction * length_m));
    }
    let size = shadow_view.uv_max - shadow_view.uv_min;
    let to_edge = min(lookup.uv - shadow_view.uv_min, shadow_view.uv_max - lookup.uv) / size;
    let depth = lookup.plane.depth;
    return saturate(2.0 * min(min(to_edge.x, to_edge.y), min(depth, 1.0 - depth)) / fraction);
}

// How much of the map around a point is not nearer to the light than the point: 0 (in shadow) to 1.
fn filtered(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    let in_cascades = light.map == MAP_CASCADES;
    var plane = lookup.plane;
    var size_px = vec2f(textureDimensions(atlas_map));
    if in_cascades {
        size_px = vec2f(textureDimensions(cascade_map));
    }
    if light.bias_method == BIAS_GRADIENT {
        var gradient = 0.0;
        if in_cascades {
            gradient = stored_gradient(cascade_map, lookup.uv);
        } else {
            gradient = stored_gradient(atlas_map, lookup.uv);
        }
        plane.depth += lookup.gradient_bias * min(gradient, lookup.steepest);
    }
    let taps = select(FILTER_TAPS, light.filter_taps, FILTER_TAPS == 0u);
    let half = max(light.filter_half - light.filter_falloff * receiver.view_depth, 0.5);
    let at = lookup.uv * size_px;
    // Centre of the texel up and left of the point, and how far the point is past it.
    let base = floor(at + 0.5) - 0.5;
    let s = at - base;
    let x_axis = tent_axis(taps, half, s.x, plane.slope.x);
    let y_axis = tent_axis(taps, half, s.y, plane.slope.y);
    var lit = 0.0;
    for (var y = 0u; y < taps; y++) {
        for (var x = 0u; x < taps; x++) {
            let tap = vec2f(x_axis.offset[x], y_axis.offset[y]);
            let uv = (base + tap) / size_px;
            let depth = tent_depth(plane, x_axis.rise[x] + y_axis.rise[y], tap - s);
            var compared = 0.0;
            if in_cascades {
                compared = textureSampleCompareLevel(cascade_map, shadow_sampler, uv, depth);
            } else {
                compared = textureSampleCompareLevel(atlas_map, shadow_sampler, uv, depth);
            }
            lit += x_axis.weight[x] * y_axis.weight[y] * compared;
        }
    }
    return lit;
}

// Interleaved gradient noise, 0 up to 1: Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014.
fn pixel_noise(pixel: vec2f) -> f32 {
    return fract(52.9829189 * fract(dot(pixel, vec2f(0.06711056, 0.00583715))));
}

// How much of the shadows is left at this distance: all of it before the fade begins, nothing at its end.
fn shadow_fade(light: ShadowLight, view_depth: f32) -> f32 {
    return light.strength * saturate((light.fade_end_m - view_depth) * light.fade_per_m);
}

// What is left of the shadows at the outer edge of the last view.
fn edge_fade(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    if light.edge_fade <= 0.0 || lookup.view + 1u != light.view_count {
        return 1.0;
    }
    return inner_part(light, receiver, lookup, light.edge_fade);
}

// How much what one view says counts where the next one covers the point too: less in its outer part.
fn blend_weight(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    if (receiver.flags & RECEIVER_COARSER) != 0u {
        return 0.0;
    }
    let inner = inner_part(light, receiver, lookup, light.blend_fraction);
    if light.blend == BLEND_DITHER {
        return select(0.0, 1.0, pixel_noise(receiver.pixel) < inner);
    }
    return inner;
}

// The view that a point is read from, the next one, and how much the first counts: all, where there is no next one.
struct Blend {
    first: Lookup,
    next: Lookup,
    weight: f32,
}

fn blend_at(light: ShadowLight, receiver: Receiver) -> Blend {
    var blend: Blend;
    blend.weight = 1.0;
    let blends = light.blend != BLEND_HARD || (receiver.flags & RECEIVER_COARSER) != 0u;
    var begin = 0u;
    for (var i = 0u; i < 2u && begin < light.view_count; i++) {
        let lookup = find(light, receiver, begin);
        if !lookup.covered {
            break;
        }
        if i == 1u {
            // Its biases are in its own texels.
            blend.next = lookup;
            blend.weight = blend_weight(light, receiver, blend.first);
        } else {
            blend.first = lookup;
            begin = select(light.view_count, lookup.view + 1u, blends);
        }
    }
    return blend;
}

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    if !SHADOWED || light >= arrayLength(&shadow_lights) {
        return vec3f(1.0);
    }
    let shadow = shadow_lights[light];
    let strength = shadow_fade(shadow, receiver.view_depth);
    if shadow.view_count == 0u || strength <= 0.0 {
        return vec3f(1.0);
    }
    let blend = blend_at(shadow, receiver);
    if !blend.first.covered {
        return vec3f(1.0);
    }
    var lit = 0.0;
    var lookup = blend.first;
    var weight = blend.weight;
    for (var i = 0u; i < 2u; i++) {
        if weight > 0.0 {
            lit += weight * filtered(shadow, receiver, lookup);
        }
        lookup = blend.next;
        weight = 1.0 - blend.weight;
    }
    return vec3f(mix(1.0, lit, strength * edge_fade(shadow, receiver, blend.first)));
}

fn cascade_tint(cascade: u32) -> vec3f {
    switch cascade {
        case 0u: { return vec3f(1.0, 0.35, 0.3); }
        case 1u: { return vec3f(0.4, 0.9, 0.35); }
        case 2u: { return vec3f(0.35, 0.55, 1.0); }
        case 3u: { return vec3f(1.0, 0.85, 0.3); }
        case 4u: { return vec3f(0.3, 0.9, 0.9); }
        case 5u: { return vec3f(1.0, 0.6, 0.25); }
        case 6u: { return vec3f(0.6, 0.6, 0.6); }
        case 7u: { return vec3f(1.0, 0.5, 0.8); }
        default: { return vec3f(0.85, 0.5, 0.95); }
    }
}

// The colour of the cascade that is read, paler as the shadows fade, mixed where cascades blend; violet in the atlas; white
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
    let fade = shadow_fade(shadow, receiver.view_depth) * edge_fade(shadow, receiver, blend.first);
    return mix(vec3f(1.0), color, fade);
}

fn view_tint(light: ShadowLight, lookup: Lookup) -> vec3f {
    return cascade_tint(shadow_views[light.first_view + lookup.view].cascade);
}
