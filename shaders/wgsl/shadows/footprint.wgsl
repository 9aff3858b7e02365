// Samples of a pixel that is wider than the texels of a shadow map. With one lookup its shadows would be those of a small part of the
// pixel: edges would be jagged, and would jump as the light turns.
#define_import_path shadowgraph::shadows::footprint
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::{Lookup, light_axes, map_per_metre}
#import shadowgraph::shadows::maps::map_size
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}
#import shadowgraph::shadows::variant::DIRECTIONAL
#import shadowgraph::shadows::views::light_view

// A rotated grid, in pixels from the centre.
const SAMPLES: u32 = 4u;
const SAMPLE_POINTS = array(vec2f(-0.125, -0.375), vec2f(0.375, -0.125), vec2f(0.125, 0.375), vec2f(-0.375, 0.125));
// Widths of a pixel, in texels, at which the samples begin to part, and from which they cover all of it.
const BEGIN_TEXELS: f32 = 2.0;
const FULL_TEXELS: f32 = 3.0;

// A pixel on the receiver's plane, in a shadow map.
struct Footprint {
    // Changes of x, y (texels) and depth to the next pixel right and down.
    right: vec3f,
    down: vec3f,
    // The width of the pixel across its longer side, texels.
    width: f32,
    // How much of the pixel the samples cover: 0 (only its centre) to 1.
    spread: f32,
}

// The change in the map over an offset from the receiver, to first order.
fn change_over(shadow_view: ShadowView, light: ShadowLight, lookup: Lookup, offset: vec3f) -> vec3f {
    if DIRECTIONAL {
        // All cascades have the axes of the first.
        return offset * light_axes(light_view(light, 0u)) * map_per_metre(shadow_view);
    }
    let change = shadow_view.map_from_world * vec4f(offset, 0.0);
    return (change.xyz - change.w * vec3f(lookup.uv, lookup.depth)) / lookup.w * vec3f(map_size(light.map), 1.0);
}

fn footprint_of(shadow_view: ShadowView, light: ShadowLight, receiver: Receiver, lookup: Lookup) -> Footprint {
    var footprint: Footprint;
    if light.supersample == 0u {
        return footprint;
    }
    footprint.right = change_over(shadow_view, light, lookup, receiver.ddx_position);
    footprint.down = change_over(shadow_view, light, lookup, receiver.ddy_position);
    let right = footprint.right.xy;
    let down = footprint.down.xy;
    footprint.width = abs(determinant(mat2x2f(right, down))) / max(max(length(right), length(down)), 1e-9);
    footprint.spread = saturate((footprint.width - BEGIN_TEXELS) / (FULL_TEXELS - BEGIN_TEXELS));
    return footprint;
}

// The lookup at a sample; without spread that of the receiver. Like the taps of a tent filter it is nearer to the light on either
// side of the centre: otherwise the foot of a lit wall would be dark.
fn sampled(shadow_view: ShadowView, light: ShadowLight, lookup: Lookup, footprint: Footprint, i: u32) -> Lookup {
    let point = SAMPLE_POINTS[i] * footprint.spread;
    let offset = point.x * footprint.right + point.y * footprint.down;
    let texels = length(offset.xy);
    let rise = max(min(abs(offset.z), texels * lookup.max_gradient), texels * lookup.plane.min_slope);
    var moved = lookup;
    moved.uv = clamp(lookup.uv + offset.xy / map_size(light.map), shadow_view.uv_min, shadow_view.uv_max);
    moved.plane.depth += rise;
    moved.min_radius = 0.5 * footprint.width * footprint.spread;
    moved.turn = f32(i) / f32(SAMPLES);
    return moved;
}
