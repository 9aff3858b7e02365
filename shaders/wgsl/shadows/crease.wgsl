// Finds points that a surface hides from the light where it meets theirs. In a crease most texels of a filter are past that surface
// and lit, and would leave a bright line.
//
// The surface is extended as a plane from texels of the map to the point, which is hidden if it is farther from the light than the
// plane. At a concave crease that the light reaches, points are nearer than the plane of the other side.
#define_import_path shadowgraph::shadows::crease
#import shadowgraph::shadows::lookup::{Lookup, ReceiverPlane}
#import shadowgraph::shadows::maps::{map_size, stored_depth}
#import shadowgraph::shadows::tent::MAX_SHADOW_DEPTH
#import shadowgraph::shadows::types::ShadowLight

// The largest difference of texels from a plane, relative to its gradient.
const TOLERANCE: f32 = 0.1;
// The least gradient of the surface's height, relative to the error of the receiver's plane. At a right angle it is at least 16;
// between facets of one shape it is small, and rounding would decide.
const MIN_GRADIENT: f32 = 10.0;

// The height of the surface in a texel above the receiver's plane, in depth; `at`: the receiver, in texels.
fn height_in(map: u32, texel: vec2f, plane: ReceiverPlane, at: vec2f) -> f32 {
    let depth = stored_depth(map, vec2i(texel));
    let height = depth - plane.depth - dot(plane.slope, texel + 0.5 - at);
    // Nothing was drawn, or it was moved to the near plane.
    return select(-1.0, height, depth > 0.0 && depth < MAX_SHADOW_DEPTH);
}

// `radius_texels`: the largest distance of the crease from the point.
fn is_behind_crease(light: ShadowLight, lookup: Lookup, radius_texels: f32) -> bool {
    let plane = lookup.unbiased;
    if light.close_creases == 0u || plane.error == 0.0 {
        return false;
    }
    // Two by two texels on the side where the receiver's plane falls away from the light: the surface rises from it there.
    let at = lookup.uv * map_size(light.map);
    let side = select(vec2f(1.0), vec2f(-1.0), plane.slope > vec2f(0.0));
    let nearest = floor(at + 0.5 * side);
    var heights = vec4f(0.0);
    var i = 0u;
    loop {
        let step = vec2f(f32(i & 1u), f32(i >> 1u));
        let height = height_in(light.map, nearest + step * side, plane, at);
        heights = select(heights, vec4f(height), vec4u(0u, 1u, 2u, 3u) == vec4u(i));
        i++;
        if i == 4u {
            break;
        }
    }
    if any(heights < vec4f(plane.error)) {
        return false;
    }
    let gradient = 0.5 * side
        * vec2f(heights.y + heights.w - heights.x - heights.z, heights.z + heights.w - heights.x - heights.y);
    let twist = abs(heights.x + heights.w - heights.y - heights.z);
    let tolerance = plane.error + TOLERANCE * (abs(gradient.x) + abs(gradient.y));
    // Of the surface's plane at the point.
    let height = 0.25 * dot(heights, vec4f(1.0)) - dot(gradient, nearest + 0.5 + 0.5 * side - at);
    let is_steep = length(gradient) > MIN_GRADIENT * plane.error;
    if !is_steep || twist > tolerance || height < plane.error || height > radius_texels * length(gradient) {
        return false;
    }
    // The surface begins at the crease: texels before it show the surface, those past it do not.
    var is_crease = true;
    i = 1u;
    loop {
        let steps = select(vec2f(f32(i & 1u), f32(i >> 1u)), vec2f(2.0), i == 4u);
        let texel = nearest - steps * side;
        let expected = height + dot(gradient, texel + 0.5 - at);
        let found = height_in(light.map, texel, plane, at);
        let is_before = expected > -tolerance && found > expected - tolerance;
        let is_past = expected < tolerance && found < expected - length(gradient);
        is_crease = is_before || is_past;
        i++;
        if i == 5u || !is_crease {
            break;
        }
    }
    return is_crease;
}
