// Where a receiver is looked up in a shadow view, with its biases.
#define_import_path shadowgraph::shadows::lookup
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::types::{ShadowView, ShadowLight, BIAS_PLANE, BIAS_SLOPE}
#import shadowgraph::shadows::tent::{TentPlane, MAX_SHADOW_DEPTH}
#import shadowgraph::shadows::variant::{DIRECTIONAL, SIMPLE}

// The cosine below which a surface is edge-on to the light.
const EDGE_ON: f32 = 1e-4;
// The error of a receiver's plane, in texels, and of depths that are extended to the point, in steps of the map's depth.
const PLANE_ERROR: f32 = 0.05;
const PLANE_ERROR_STEPS: f32 = 4.0;

struct Lookup {
    // Whether the view covers the point.
    covered: bool,
    // The index of the view among those of the light.
    view: u32,
    // Texture coordinates in the map, depth without biases, and w, by which they were divided.
    uv: vec2f,
    depth: f32,
    w: f32,
    // For one of several lookups of a pixel: half the width of the pixel, texels, which is the least radius of filters that adapt
    // theirs, and an offset of the noise, 0 to below 1.
    min_radius: f32,
    turn: f32,
    plane: TentPlane,
    unbiased: ReceiverPlane,
    // For gradient biases: the largest gradient that is followed, in depth per texel, and its factor.
    max_gradient: f32,
    gradient_bias: f32,
}

// The receiver's plane in map space at uv, without biases.
struct ReceiverPlane {
    depth: f32,
    // Change of depth per texel right and down.
    slope: vec2f,
    // The error of differences from the plane; 0 if it is too steep to be followed.
    error: f32,
}

// How the light meets the receiver's surface: the same in all cascades of a light.
struct Incidence {
    // Along the light's axes right, up and to the light: the receiver's position, if the light is directional, and its normal.
    position: vec3f,
    normal: vec3f,
    // The normal times the distance to the light; 1 for a directional light.
    facing: f32,
    // Of the angle between the normal and the light; 1 where the bias does not depend on it.
    sine: f32,
}

// The light's axes right, up and to the light, unit length.
fn light_axes(shadow_view: ShadowView) -> mat3x3f {
    let m = shadow_view.clip_from_world;
    let scale = shadow_view.axis_scale * shadow_view.texel_scale;
    let right = vec3f(m[0].x, m[1].x, m[2].x) * scale.x;
    let up = vec3f(m[0].y, m[1].y, m[2].y) * scale.y;
    return mat3x3f(right, up, shadow_view.light.xyz);
}

fn incidence_in(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver) -> Incidence {
    let normal = receiver.geometric_normal;
    let axes = light_axes(shadow_view);
    var along = normal * axes;
    var facing = along.z;
    if !DIRECTIONAL {
        // Unit length for a directional light, the full distance for a spot light.
        let to_light = shadow_view.light.xyz - receiver.position * shadow_view.light.w;
        along.z = dot(normal, normalize(to_light));
        facing = dot(normal, to_light);
    }
    let sine = select(1.0, sqrt(saturate(1.0 - along.z * along.z)), SIMPLE || light.normal_sine == 1u);
    return Incidence(receiver.position * axes, along, max(facing, EDGE_ON), sine);
}

// Changes of x, y (texels of the map) and depth per metre along the axes of a directional light.
fn map_per_metre(shadow_view: ShadowView) -> vec3f {
    return vec3f(vec2f(1.0, -1.0) / shadow_view.texel_scale, shadow_view.depth_per_texel) / shadow_view.texel_world;
}

// Texture coordinates and depth of the receiver, biased along its normal, before the division by w.
fn position_in(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver, incidence: Incidence) -> vec4f {
    let bias = shadow_view.bias_scale * light.normal_bias_texels * shadow_view.texel_world * incidence.sine;
    let m = shadow_view.map_from_world;
    if DIRECTIONAL {
        let per_metre = map_per_metre(shadow_view) * vec3f(light.texel_uv, 1.0);
        return vec4f((incidence.position + incidence.normal * bias) * per_metre + m[3].xyz, 1.0);
    }
    let unmoved = m * vec4f(receiver.position, 1.0);
    return m * vec4f(receiver.position + receiver.geometric_normal * (bias * max(unmoved.w, 0.0)), 1.0);
}

// The receiver's change of depth per texel right and down.
fn slope_in(shadow_view: ShadowView, incidence: Incidence) -> vec2f {
    let slope = vec2f(-incidence.normal.x, incidence.normal.y) / incidence.facing;
    return slope * shadow_view.texel_scale * shadow_view.depth_per_texel;
}

// The slope that taps follow.
fn biased_slope(shadow_view: ShadowView, light: ShadowLight, slope: vec2f, max_slope: f32) -> vec2f {
    return slope * (shadow_view.bias_scale * light.slope_bias * max_slope / max(length(slope), max_slope));
}

// `slope`: the one that taps follow.
fn covers(shadow_view: ShadowView, light: ShadowLight, uv: vec2f, depth: f32, slope: vec2f) -> bool {
    // Neighbours of the receiver that are clamped to the near plane would count as blockers.
    let rise = f32(light.filter_taps) * (abs(slope.x) + abs(slope.y));
    let inside = all(uv >= shadow_view.uv_min) && all(uv <= shadow_view.uv_max);
    let before_end = depth > 0.0 || shadow_view.is_open == 1u;
    return inside && before_end && depth + rise < MAX_SHADOW_DEPTH;
}

// Whether the view of a directional light covers the receiver.
fn covers_receiver(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver, incidence: Incidence) -> bool {
    let position = position_in(shadow_view, light, receiver, incidence);
    let max_slope = light.max_slope * shadow_view.depth_per_texel;
    let slope = biased_slope(shadow_view, light, slope_in(shadow_view, incidence), max_slope);
    return covers(shadow_view, light, position.xy, position.z, slope);
}

fn look_up(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver, incidence: Incidence) -> Lookup {
    var lookup: Lookup;
    let position = position_in(shadow_view, light, receiver, incidence);
    // Behind a spot light, the division would mirror the point to its front; in the empty view w is 0.
    if !DIRECTIONAL && position.w <= 0.0 {
        return lookup;
    }
    lookup.uv = position.xy / position.w;
    var depth = position.z / position.w;
    lookup.depth = depth;
    lookup.w = position.w;
    let depth_per_texel = shadow_view.depth_per_texel / position.w;
    // On a plane, depth is linear in the map for both kinds of light.
    let slope = slope_in(shadow_view, incidence);
    let max_slope = light.max_slope * depth_per_texel;
    lookup.max_gradient = max_slope;
    // The bias along the normal moves the point towards the light by this change of depth, seen along the light.
    let scale = shadow_view.bias_scale;
    let cosine = incidence.normal.z;
    let lift = scale * light.normal_bias_texels * incidence.sine * depth_per_texel / max(cosine, EDGE_ON);
    let followed = length(slope) < max_slope && cosine > EDGE_ON;
    let error = PLANE_ERROR * (depth_per_texel + length(slope)) + PLANE_ERROR_STEPS * shadow_view.depth_step;
    lookup.unbiased = ReceiverPlane(depth - lift, slope, select(0.0, error, followed));
    lookup.gradient_bias = scale * light.slope_bias;
    let followed_slope = biased_slope(shadow_view, light, slope, max_slope);
    lookup.covered = covers(shadow_view, light, lookup.uv, depth, followed_slope);
    depth = max(depth, 0.0);
    depth += scale * light.depth_bias_texels * depth_per_texel + shadow_view.depth_step;
    lookup.plane.depth = depth;
    if SIMPLE || light.bias_method == BIAS_PLANE {
        lookup.plane.slope = followed_slope;
        lookup.plane.min_slope = scale * light.min_slope * depth_per_texel;
    } else if light.bias_method == BIAS_SLOPE {
        lookup.plane.depth += max(abs(followed_slope.x), abs(followed_slope.y));
    }
    return lookup;
}
