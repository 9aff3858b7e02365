// The technique `pcf`: cascades for the main light, an atlas for the others, read with a 5 x 5 tent filter.
#define_import_path shadowgraph::technique
#import shadowgraph::receiver::{Receiver, RECEIVER_COARSER}
#import shadowgraph::shadows::types::{ShadowView, ShadowLight, MAP_CASCADES}

@group(1) @binding(0) var<storage, read> shadow_views: array<ShadowView>;
@group(1) @binding(1) var<storage, read> shadow_lights: array<ShadowLight>;
@group(1) @binding(2) var cascade_map: texture_depth_2d;
@group(1) @binding(3) var atlas_map: texture_depth_2d;
// Linear, GreaterEqual: lit where the point is at least as near to the light as what the map has.
@group(1) @binding(4) var shadow_sampler: sampler_comparison;

// Casters before the near plane are drawn at depth 1: nothing may be nearer than they are.
const NEAREST: f32 = 0.999999;
// The cosine below which a surface counts as edge-on to the light.
const EDGE_ON: f32 = 1e-4;
const FILTER_SUM: f32 = 144.0;
// Texels.
const FILTER_REACH: f32 = 3.0;

// A receiver as one view sees it.
struct Lookup {
    // Whether the view covers the point.
    covered: bool,
    // In parts of the map.
    uv: vec2f,
    depth: f32,
    // How depth changes on the receiver's plane per texel right and down.
    slope: vec2f,
    // How much depth taps beside the middle may differ in any direction, per texel.
    min_slope: f32,
}

fn look_up(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver) -> Lookup {
    var lookup: Lookup;
    let normal = receiver.geometric_normal;
    // Unit length for a directional light, whole distance for a spot light.
    let to_light = shadow_view.light.xyz - receiver.position * shadow_view.light.w;
    let cosine = dot(normal, normalize(to_light));
    let unmoved = shadow_view.map_from_world * vec4f(receiver.position, 1.0);
    let sine = sqrt(saturate(1.0 - cosine * cosine));
    let offset_m = light.normal_bias_texels * shadow_view.texel_world * max(unmoved.w, 0.0) * sine;
    let position = shadow_view.map_from_world * vec4f(receiver.position + normal * offset_m, 1.0);
    // Behind a spot light, division would mirror the point to its front.
    if position.w <= 0.0 {
        return lookup;
    }
    lookup.uv = position.xy / position.w;
    lookup.depth = position.z / position.w;
    let depth_per_texel = shadow_view.depth_per_texel / position.w;
    // On a plane, depth is linear in the map, for both kinds of light: its change per texel follows from where
    // the normal lies between the light's axes and the way to the light.
    let across = (shadow_view.clip_from_world * vec4f(normal, 0.0)).xy * shadow_view.axis_scale;
    let facing = max(dot(normal, to_light), EDGE_ON);
    let slope = vec2f(-across.x, across.y) * shadow_view.depth_per_texel / facing;
    let steepest = light.max_slope * depth_per_texel;
    lookup.slope = slope * (light.slope_bias * steepest / max(length(slope), steepest));
    lookup.min_slope = light.min_slope * depth_per_texel;
    // Where the receiver's own surroundings are clamped to the near plane, they would be taken for blockers.
    let rise = FILTER_REACH * (abs(lookup.slope.x) + abs(lookup.slope.y));
    let inside = all(lookup.uv >= shadow_view.uv_min) && all(lookup.uv <= shadow_view.uv_max);
    lookup.covered = inside && lookup.depth > 0.0 && lookup.depth + rise < NEAREST;
    lookup.depth += light.depth_bias_texels * depth_per_texel;
    return lookup;
}

// Nine bilinear comparisons that add up to a tent of 5 x 5 texels, 0 (in shadow) to 1.
//
// Each is compared with the receiver's plane at that of its four texels that is nearest to the light, so a flat
// surface never shadows itself. Taps on the other side of the middle are allowed as much, and all of them at
// least min_slope: otherwise the foot of a lit wall would be dark, as half of the filter falls on the wall.
fn tent(map: texture_depth_2d, lookup: Lookup) -> f32 {
    let size_px = vec2f(textureDimensions(map));
    let at = lookup.uv * size_px;
    // Centre of the texel up and left of the point, and how far the point is past it.
    let base = floor(at + 0.5) - 0.5;
    let s = at - base;
    let weight_x = vec3f(4.0 - 3.0 * s.x, 7.0, 1.0 + 3.0 * s.x);
    let weight_y = vec3f(4.0 - 3.0 * s.y, 7.0, 1.0 + 3.0 * s.y);
    let tap_x = vec3f((3.0 - 2.0 * s.x) / weight_x.x - 2.0, (3.0 + s.x) / 7.0, s.x / weight_x.z + 2.0);
    let tap_y = vec3f((3.0 - 2.0 * s.y) / weight_y.x - 2.0, (3.0 + s.y) / 7.0, s.y / weight_y.z + 2.0);
    // The texels on both sides of each tap, from the point.
    let first = vec3f(-2.0, 0.0, 2.0);
    let rise_x = max((first - s.x) * lookup.slope.x, (first + 1.0 - s.x) * lookup.slope.x);
    let rise_y = max((first - s.y) * lookup.slope.y, (first + 1.0 - s.y) * lookup.slope.y);
    var sum = 0.0;
    for (var y = 0u; y < 3u; y++) {
        for (var x = 0u; x < 3u; x++) {
            let tap = vec2f(tap_x[x], tap_y[y]);
            let rise = max(abs(rise_x[x] + rise_y[y]), (length(tap - s) + 0.5) * lookup.min_slope);
            let depth = min(lookup.depth + rise, NEAREST);
            let uv = (base + tap) / size_px;
            sum += weight_x[x] * weight_y[y] * textureSampleCompareLevel(map, shadow_sampler, uv, depth);
        }
    }
    return sum / FILTER_SUM;
}

// How much of the shadows is left at this distance: all of it before the fade begins, nothing at its end.
fn shadow_fade(light: ShadowLight, view_depth: f32) -> f32 {
    return light.strength * saturate((light.fade_end_m - view_depth) * light.fade_per_m);
}

fn shadow_visibility(light: u32, receiver: Receiver) -> vec3f {
    if light >= arrayLength(&shadow_lights) {
        return vec3f(1.0);
    }
    let shadow = shadow_lights[light];
    let strength = shadow_fade(shadow, receiver.view_depth);
    if shadow.view_count == 0u || strength <= 0.0 {
        return vec3f(1.0);
    }
    // The first that covers the point has the finest texels.
    var skips = (receiver.flags & RECEIVER_COARSER) != 0u;
    var lookup: Lookup;
    for (var i = 0u; i < shadow.view_count; i++) {
        let found = look_up(shadow_views[shadow.first_view + i], shadow, receiver);
        if found.covered {
            lookup = found;
            if !skips {
                break;
            }
            skips = false;
        }
    }
    if !lookup.covered {
        return vec3f(1.0);
    }
    var lit = 1.0;
    if shadow.map == MAP_CASCADES {
        lit = tent(cascade_map, lookup);
    } else {
        lit = tent(atlas_map, lookup);
    }
    return vec3f(mix(1.0, lit, strength));
}

fn cascade_tint(cascade: u32) -> vec3f {
    switch cascade {
        case 0u: { return vec3f(1.0, 0.35, 0.3); }
        case 1u: { return vec3f(0.4, 0.9, 0.35); }
        case 2u: { return vec3f(0.35, 0.55, 1.0); }
        case 3u: { return vec3f(1.0, 0.85, 0.3); }
        default: { return vec3f(0.85, 0.5, 0.95); }
    }
}

// The colour of the cascade that is read, paler as the shadows fade; violet in the atlas; white without shadows.
fn shadow_debug_color(light: u32, receiver: Receiver) -> vec3f {
    if light >= arrayLength(&shadow_lights) {
        return vec3f(1.0);
    }
    let shadow = shadow_lights[light];
    for (var i = 0u; i < shadow.view_count; i++) {
        let shadow_view = shadow_views[shadow.first_view + i];
        if look_up(shadow_view, shadow, receiver).covered {
            let fade = shadow_fade(shadow, receiver.view_depth);
            return mix(vec3f(1.0), cascade_tint(shadow_view.cascade), fade);
        }
    }
    return vec3f(1.0);
}
