// The depths of a page: steps of 16 bits between the farthest and the nearest caster of the page, as even along the light as its projection
// allows.
#define_import_path shadowgraph::shadows::page_depths
#import shadowgraph::shadows::variant::DIRECTIONAL

// Step 0 is that of texels without a caster.
const LAST_STEP: f32 = 65535.0;
// The least range of a page, relative to its nearest depth: a step is no smaller than the rounding of an f32.
const LEAST_RANGE: f32 = 0.0078125;
// Added to the step of a receiver: what rounding may add to that of a caster at the same depth.
const ROUNDING: f32 = 0.25;

// How a page stores depths.
struct PageDepths {
    // The depth of the farthest caster, at step 1.
    first: f32,
    // Steps for each unit of depth, there.
    scale: f32,
    // 0 where depth is linear along the light. Otherwise 1 / (first - the depth at an infinite distance): steps are linear along the light where
    // depth is not.
    curve: f32,
}

// For a page whose casters have depths from `first` to `last`. `at_infinity`: the depth at an infinite distance, below 0, if the projection
// is a perspective one.
fn page_depths(first: f32, last: f32, is_perspective: bool, at_infinity: f32) -> PageDepths {
    let range = max(last - first, LEAST_RANGE * last);
    let curve = select(0.0, 1.0 / (first - at_infinity), is_perspective);
    return PageDepths(first, (LAST_STEP - 1.0) * (1.0 + curve * range) / range, curve);
}

// The step of a depth that is not farther than the first, with a fraction.
fn step_at(depths: PageDepths, depth: f32) -> f32 {
    let above = depth - depths.first;
    if DIRECTIONAL {
        return 1.0 + depths.scale * above;
    }
    return 1.0 + depths.scale * above / (1.0 + depths.curve * above);
}

// What the texel of a caster stores. Its depth is rounded away from the light: it does not darken itself.
fn stored_step(depths: PageDepths, depth: f32) -> f32 {
    return clamp(floor(step_at(depths, depth)), 1.0, LAST_STEP);
}

// The depth of a step; 0 where there is no caster.
fn depth_of_step(depths: PageDepths, step: f32) -> f32 {
    let above = max(step - 1.0, 0.0);
    let curve = select(depths.curve, 0.0, DIRECTIONAL);
    return select(0.0, depths.first + above / (depths.scale - curve * above), step > 0.0);
}

// The step to compare with those of texels, for a receiver with a depth: texels are nearer to the light if theirs is larger.
fn compared_step(depths: PageDepths, depth: f32) -> f32 {
    return select(0.0, min(step_at(depths, depth) + ROUNDING, LAST_STEP), depth >= depths.first);
}

// The change of depth from one step to the next.
fn step_width(depths: PageDepths, depth: f32) -> f32 {
    let bend = 1.0 + select(depths.curve, 0.0, DIRECTIONAL) * max(depth - depths.first, 0.0);
    return bend * bend / max(depths.scale, 1e-30);
}
