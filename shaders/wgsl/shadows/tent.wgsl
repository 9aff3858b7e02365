// The shadow filter: a tent of bilinear comparisons.
//
// The weight of a texel is the area above it of a triangle as wide as the filter and centred at the point; one tap compares and
// blends two by two texels. `filter.rs` is the reference.
#define_import_path shadowgraph::shadows::tent

// Casters in front of the near plane are drawn at depth 1: receivers are kept behind them.
const MAX_SHADOW_DEPTH: f32 = 0.999999;

// The receiver's plane in map space.
struct TentPlane {
    depth: f32,
    // Change of depth per texel right and down.
    slope: vec2f,
    // The least slope that off-centre taps allow for in any direction, per texel.
    min_slope: f32,
}

// The taps along one axis; unused taps have weight 0.
struct TentAxis {
    weight: vec4f,
    // Texels from the centre of the base texel.
    offset: vec4f,
    // How much nearer to the light the plane is at the nearest texel of a tap than at the point.
    rise: vec4f,
}

// The integral of a unit-area tent from its left end at -half to x.
fn tent_integral(x: f32, half: f32) -> f32 {
    let t = clamp(x / half, -1.0, 1.0);
    return 0.5 + t - 0.5 * t * abs(t);
}

// `s`: the offset of the point from the centre of the base texel, 0 to below 1.
fn tent_axis(taps: u32, half: f32, s: f32, slope: f32) -> TentAxis {
    var axis: TentAxis;
    if taps == 1u {
        // The hardware blends two texels.
        axis.weight.x = 1.0;
        axis.offset.x = s;
        axis.rise.x = max(-s * slope, (1.0 - s) * slope);
        return axis;
    }
    let begin = -f32(taps - 1u);
    var before = tent_integral(begin - s - 0.5, half);
    for (var tap = 0u; tap < taps; tap++) {
        let first = begin + 2.0 * f32(tap);
        let middle = tent_integral(first - s + 0.5, half);
        let after = tent_integral(first - s + 1.5, half);
        let weight = after - before;
        axis.weight[tap] = weight;
        axis.offset[tap] = first + (after - middle) / max(weight, 1e-6);
        axis.rise[tap] = max((first - s) * slope, (first + 1.0 - s) * slope);
        before = after;
    }
    return axis;
}

// The depth to compare a tap of two axes with.
//
// It is the depth of the receiver's plane at the nearest to the light of the tap's four texels, so a flat surface never shadows
// itself. Taps on the other side of the centre get the same bias, and all taps at least min_slope: otherwise the foot of a lit
// wall would be dark, since half of the filter covers the wall.
fn tent_depth(plane: TentPlane, rise: f32, from_point: vec2f) -> f32 {
    return min(plane.depth + max(abs(rise), (length(from_point) + 0.5) * plane.min_slope), MAX_SHADOW_DEPTH);
}
