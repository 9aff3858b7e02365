// The facts of a lookup in a shadow map, for debugging.
#define_import_path shadowgraph::shadows::explained_lookup
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::{Lookup, incidence_in}
#import shadowgraph::shadows::maps::{map_size, stored_depth}
#import shadowgraph::shadows::types::{ShadowLight, ShadowView}

// The numbers that explanations consist of; unused ones are 0.
const FACTS: u32 = 32u;
// Those of `lookup_facts`. The others are those of the technique.
const LOOKUP_FACTS: u32 = 15u;

// The state of a light at a point.
const UNSHADOWED: f32 = 0.0;
const NOT_COVERED: f32 = 1.0;
const COVERED: f32 = 2.0;

// Metres along the ray to the light from a receiver to the surface of a stored depth; below 0 behind the receiver.
fn metres_in_front(shadow_view: ShadowView, receiver: Receiver, depth: f32, w: f32, stored: f32) -> f32 {
    // A directional light has the same change of depth per metre everywhere. For spot lights, depth is linear in 1 / w.
    let depth_per_metre = shadow_view.depth_per_texel / shadow_view.texel_world;
    if shadow_view.light.w == 0.0 {
        return (stored - depth) / depth_per_metre;
    }
    let stored_w = 1.0 / (1.0 / w + (stored - depth) / depth_per_metre);
    return (w - stored_w) / w * distance(shadow_view.light.xyz, receiver.position);
}

// `filter_half`: half the width of the filter, texels. `weight`: that of this view, where it is blended with another.
fn lookup_facts(
    shadow_view: ShadowView,
    light: ShadowLight,
    receiver: Receiver,
    lookup: Lookup,
    filter_half: f32,
    weight: f32,
    strength: f32,
) -> array<f32, FACTS> {
    var facts: array<f32, FACTS>;
    facts[0] = COVERED;
    let position = shadow_view.map_from_world * vec4f(receiver.position, 1.0);
    let depth = position.z / position.w;
    let at = lookup.uv * map_size(light.map);
    let stored = stored_depth(light.map, vec2i(floor(at)));
    let sine = incidence_in(shadow_view, light, receiver).sine;
    let depth_per_texel = shadow_view.depth_per_texel / lookup.w;
    facts[1] = strength;
    facts[2] = weight;
    facts[3] = at.x;
    facts[4] = at.y;
    facts[5] = shadow_view.texel_world * lookup.w;
    facts[6] = filter_half;
    facts[7] = depth;
    facts[8] = lookup.plane.depth;
    facts[9] = stored;
    facts[10] = metres_in_front(shadow_view, receiver, depth, position.w, stored);
    facts[11] = shadow_view.bias_scale * light.normal_bias_texels * sine;
    facts[12] = shadow_view.bias_scale * light.depth_bias_texels;
    facts[13] = length(lookup.plane.slope) / depth_per_texel;
    facts[14] = lookup.plane.min_slope / depth_per_texel;
    return facts;
}
