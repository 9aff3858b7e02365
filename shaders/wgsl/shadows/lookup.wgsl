// A receiver as one shadow view sees it: where to look, and how much nearer to the light to take it.
#define_import_path shadowgraph::shadows::lookup
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::types::{ShadowView, ShadowLight, BIAS_PLANE, BIAS_SLOPE}
#import shadowgraph::shadows::tent::{TentPlane, NEAREST}

// The cosine below which a surface counts as edge-on to the light.
const EDGE_ON: f32 = 1e-4;

struct Lookup {
    // Whether the view covers the point.
    covered: bool,
    // Which of the light's views it is, from 0.
    view: u32,
    // In parts of the map.
    uv: vec2f,
    plane: TentPlane,
    // For biases by a gradient: the steepest that is followed, in depth a texel, and what it is multiplied by.
    steepest: f32,
    gradient_bias: f32,
}

fn look_up(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver) -> Lookup {
    var lookup: Lookup;
    let normal = receiver.geometric_normal;
    // Unit length for a directional light, whole distance for a spot light.
    let to_light = shadow_view.light.xyz - receiver.position * shadow_view.light.w;
    let cosine = dot(normal, normalize(to_light));
    let unmoved = shadow_view.map_from_world * vec4f(receiver.position, 1.0);
    let sine = select(1.0, sqrt(saturate(1.0 - cosine * cosine)), light.normal_sine == 1u);
    let scale = shadow_view.bias_scale;
    let offset_m = scale * light.normal_bias_texels * shadow_view.texel_world * max(unmoved.w, 0.0) * sine;
    let position = shadow_view.map_from_world * vec4f(receiver.position + normal * offset_m, 1.0);
    // Behind a spot light, division would mirror the point to its front; in the view of nothing w is 0.
    if position.w <= 0.0 {
        return lookup;
    }
    lookup.uv = position.xy / position.w;
    var depth = position.z / position.w;
    let depth_per_texel = shadow_view.depth_per_texel / position.w;
    // On a plane, depth is linear in the map, for both kinds of light: its change per texel follows from where
    // the normal lies between the light's axes and the way to the light.
    let across = (shadow_view.clip_from_world * vec4f(normal, 0.0)).xy * shadow_view.axis_scale;
    let facing = max(dot(normal, to_light), EDGE_ON);
    var slope = vec2f(-across.x, across.y) * shadow_view.depth_per_texel / facing;
    let steepest = light.max_slope * depth_per_texel;
    lookup.steepest = steepest;
    lookup.gradient_bias = scale * light.slope_bias;
    slope *= scale * light.slope_bias * steepest / max(length(slope), steepest);
    // Where the receiver's own surroundings are clamped to the near plane, they would be taken for blockers.
    let rise = f32(light.filter_taps) * (abs(slope.x) + abs(slope.y));
    let inside = all(lookup.uv >= shadow_view.uv_min) && all(lookup.uv <= shadow_view.uv_max);
    lookup.covered = inside && depth > 0.0 && depth + rise < NEAREST;
    depth += scale * light.depth_bias_texels * depth_per_texel + shadow_view.depth_step;
    lookup.plane.depth = depth;
    if light.bias_method == BIAS_PLANE {
        lookup.plane.slope = slope;
        lookup.plane.min_slope = scale * light.min_slope * depth_per_texel;
    } else if light.bias_method == BIAS_SLOPE {
        lookup.plane.depth += max(abs(slope.x), abs(slope.y));
    }
    return lookup;
}
