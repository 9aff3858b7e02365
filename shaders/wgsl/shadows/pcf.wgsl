// The filter of the technique `pcf`: a tent of comparisons, each with a bias for its position.
#define_import_path shadowgraph::shadows::filter
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::{compared_in, map_size, stored_gradient}
#import shadowgraph::shadows::tent::{TentAxis, TentPlane, tent_axis, tent_depth}
#import shadowgraph::shadows::types::{ShadowLight, BIAS_GRADIENT}
#import shadowgraph::shadows::variant::{FILTER_TAPS, SIMPLE}

// Linear, GreaterEqual: a point is lit if it is at least as near to the light as the stored depth.
@group(1) @binding(10) var shadow_sampler: sampler_comparison;

// The radius of the filter where blockers are near, texels of the depth map.
fn filter_radius(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    return light.filter_half;
}

// A row of taps.
struct Row {
    x_axis: TentAxis,
    // Texels of the map: the base texel across, and the row's offset down from the point.
    base: vec2f,
    offset: f32,
    rise: f32,
    // The offset of the point from the base texel.
    s: vec2f,
}

fn compared(map: u32, plane: TentPlane, row: Row, across: f32, rise: f32) -> f32 {
    let tap = vec2f(across, row.offset);
    let uv = (row.base + tap) / map_size(map);
    let depth = tent_depth(plane, rise + row.rise, tap - row.s);
    return compared_in(map, shadow_sampler, uv, depth);
}

// A component. An index that is not constant would move the vector to memory.
fn component(v: vec4f, i: u32) -> f32 {
    let pair = select(v.xy, v.zw, i >= 2u);
    return select(pair.x, pair.y, (i & 1u) == 1u);
}

fn row_visibility(map: u32, plane: TentPlane, taps: u32, row: Row) -> f32 {
    let axis = row.x_axis;
    var visibility = 0.0;
    var tap = 0u;
    loop {
        visibility += component(axis.weight, tap)
            * compared(map, plane, row, component(axis.offset, tap), component(axis.rise, tap));
        tap++;
        if tap == taps {
            break;
        }
    }
    return visibility;
}

// The visibility of the light from a point, the fraction of the filter that is not nearer to the light: 0 (in shadow) to 1.
fn filtered(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    var plane = lookup.plane;
    if !SIMPLE && light.bias_method == BIAS_GRADIENT {
        plane.depth += lookup.gradient_bias * min(stored_gradient(light.map, lookup.uv), lookup.max_gradient);
    }
    let taps = select(FILTER_TAPS, light.filter_taps, FILTER_TAPS == 0u);
    let half = max(light.filter_half - light.filter_falloff * receiver.view_depth, 0.5);
    let at = lookup.uv * map_size(light.map);
    // Centre of the texel up and left of the point, and the offset of the point from it.
    let base = floor(at + 0.5) - 0.5;
    let s = at - base;
    let x_axis = tent_axis(taps, half, s.x, plane.slope.x);
    let y_axis = tent_axis(taps, half, s.y, plane.slope.y);
    var visibility = 0.0;
    var tap = 0u;
    loop {
        let row = Row(x_axis, base, component(y_axis.offset, tap), component(y_axis.rise, tap), s);
        visibility += component(y_axis.weight, tap) * row_visibility(light.map, plane, taps, row);
        tap++;
        if tap == taps {
            break;
        }
    }
    return visibility;
}
