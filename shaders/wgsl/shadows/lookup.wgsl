// Where a receiver is looked up in a shadow view, with its biases.
#define_import_path shadowgraph::shadows::lookup
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::types::{ShadowView, ShadowLight, BIAS_PLANE, BIAS_SLOPE}
#import shadowgraph::shadows::tent::{TentPlane, MAX_SHADOW_DEPTH}
#import shadowgraph::shadows::variant::SIMPLE

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

fn look_up(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver) -> Lookup {
    var lookup: Lookup;
    let normal = receiver.geometric_normal;
    // Unit length for a directional light, the full distance for a spot light.
    let to_light = shadow_view.light.xyz - receiver.position * shadow_view.light.w;
    let cosine = dot(normal, normalize(to_light));
    let unmoved = shadow_view.map_from_world * vec4f(receiver.position, 1.0);
    let sine = select(1.0, sqrt(saturate(1.0 - cosine * cosine)), SIMPLE || light.normal_sine == 1u);
    let scale = shadow_view.bias_scale;
    let offset_m = scale * light.normal_bias_texels * shadow_view.texel_world * max(unmoved.w, 0.0) * sine;
    let position = shadow_view.map_from_world * vec4f(receiver.position + normal * offset_m, 1.0);
    // Behind a spot light, the division would mirror the point to its front; in the empty view w is 0.
    if position.w <= 0.0 {
        return lookup;
    }
    lookup.uv = position.xy / position.w;
    var depth = position.z / position.w;
    lookup.depth = depth;
    lookup.w = position.w;
    let depth_per_texel = shadow_view.depth_per_texel / position.w;
    // On a plane, depth is linear in the map for both kinds of light: its change per texel follows from the normal relative to the
    // light's axes and the direction to the light.
    let axis_scale = shadow_view.axis_scale * shadow_view.texel_scale;
    let normal_in_light = (shadow_view.clip_from_world * vec4f(normal, 0.0)).xy * axis_scale;
    let facing = max(dot(normal, to_light), EDGE_ON);
    var slope = vec2f(-normal_in_light.x, normal_in_light.y) * shadow_view.texel_scale * shadow_view.depth_per_texel / facing;
    let max_slope = light.max_slope * depth_per_texel;
    lookup.max_gradient = max_slope;
    // The bias along the normal moves the point towards the light by this change of depth, seen along the light.
    let lift = scale * light.normal_bias_texels * sine * depth_per_texel / max(cosine, EDGE_ON);
    let followed = length(slope) < max_slope && cosine > EDGE_ON;
    let error = PLANE_ERROR * (depth_per_texel + length(slope)) + PLANE_ERROR_STEPS * shadow_view.depth_step;
    lookup.unbiased = ReceiverPlane(depth - lift, slope, select(0.0, error, followed));
    lookup.gradient_bias = scale * light.slope_bias;
    slope *= scale * light.slope_bias * max_slope / max(length(slope), max_slope);
    // Neighbours of the receiver that are clamped to the near plane would count as blockers.
    let rise = f32(light.filter_taps) * (abs(slope.x) + abs(slope.y));
    let inside = all(lookup.uv >= shadow_view.uv_min) && all(lookup.uv <= shadow_view.uv_max);
    let before_end = depth > 0.0 || shadow_view.is_open == 1u;
    lookup.covered = inside && before_end && depth + rise < MAX_SHADOW_DEPTH;
    depth = max(depth, 0.0);
    depth += scale * light.depth_bias_texels * depth_per_texel + shadow_view.depth_step;
    lookup.plane.depth = depth;
    if SIMPLE || light.bias_method == BIAS_PLANE {
        lookup.plane.slope = slope;
        lookup.plane.min_slope = scale * light.min_slope * depth_per_texel;
    } else if light.bias_method == BIAS_SLOPE {
        lookup.plane.depth += max(abs(slope.x), abs(slope.y));
    }
    return lookup;
}
