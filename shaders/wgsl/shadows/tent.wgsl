// The shadow filter: a tent of bilinear comparisons.
//
// Each texel counts with the area of a triangle, as wide as the filter and centred at the point, over it; two by two texels
// are compared and mixed by one tap. `filter.rs` is the twin.
#define_import_path shadowgraph::shadows::tent

// Casters before the near plane are drawn at depth 1: nothing may be nearer than they are.
const NEAREST: f32 = 0.999999;

// The receiver's plane as a map has it.
struct TentPlane {
    depth: f32,
    // How depth changes per texel right and down.
    slope: vec2f,
    // How much depth taps beside the middle may differ in any direction, per texel.
    min_slope: f32,
}

// The taps along one axis; those beyond the number of taps weigh nothing.
struct TentAxis {
    weight: vec4f,
    // Texels from the centre of the texel that the point is counted from.
    offset: vec4f,
    // How much nearer to the light the plane is at the nearest of a tap's texels than at the point.
    rise: vec4f,
}

// The area, of 1 in all, of a tent from its left end at -half to x.
fn tent_integral(x: f32, half: f32) -> f32 {
    let t = clamp(x / half, -1.0, 1.0);
    return 0.5 + t - 0.5 * t * abs(t);
}

// `s`: how far the point is past the centre of the texel it is counted from, 0 up to 1.
fn tent_axis(taps: u32, half: f32, s: f32, slope: f32) -> TentAxis {
    var axis: TentAxis;
    if taps == 1u {
        // The hardware's own mix of two texels.
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
// It is that of the receiver's plane at that of the tap's four texels that is nearest to the light, so a flat surface never
// shadows itself. Taps on the other side of the middle are allowed as much, and all of them at least min_slope: otherwise the
// foot of a lit wall would be dark, as half of the filter falls on the wall.
fn tent_depth(plane: TentPlane, rise: f32, from_point: vec2f) -> f32 {
    return min(plane.depth + max(abs(rise), (length(from_point) + 0.5) * plane.min_slope), NEAREST);
}
