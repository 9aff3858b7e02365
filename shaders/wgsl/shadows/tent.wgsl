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

fn tent_integrals(x: vec4f, half: f32) -> vec4f {
    let t = clamp(x / half, vec4f(-1.0), vec4f(1.0));
    return 0.5 + t - 0.5 * t * abs(t);
}

// `s`: the offset of the point from the centre of the base texel, 0 to below 1. All taps are computed at once: those past `taps` are
// beyond the end of the tent.
fn tent_axis(taps: u32, half: f32, s: f32, slope: f32) -> TentAxis {
    var axis: TentAxis;
    if taps == 1u {
        // The hardware blends two texels.
        axis.weight.x = 1.0;
        axis.offset.x = s;
        axis.rise.x = max(-s * slope, (1.0 - s) * slope);
        return axis;
    }
    let first = vec4f(0.0, 2.0, 4.0, 6.0) - f32(taps - 1u);
    let from_point = first - s;
    let middle = tent_integrals(from_point + 0.5, half);
    let after = tent_integrals(from_point + 1.5, half);
    let before = vec4f(tent_integral(from_point.x - 0.5, half), after.xyz);
    axis.weight = after - before;
    axis.offset = first + (after - middle) / max(axis.weight, vec4f(1e-6));
    axis.rise = max(from_point * slope, (from_point + 1.0) * slope);
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
