// Anti-aliasing of the finished image (Lottes, "FXAA", 2009, a short form of the quality variant).
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var linear: sampler;

// Perceptual luma: the image is linear, perceived contrast is not.
fn luma(color: vec3f) -> f32 {
    return sqrt(dot(color, vec3f(0.299, 0.587, 0.114)));
}

fn luma_at(uv: vec2f) -> f32 {
    return luma(textureSampleLevel(image, linear, uv, 0.0).rgb);
}

// The luma of the pixel at an offset.
fn luma_of(pixel: vec2i) -> f32 {
    return luma(textureLoad(image, clamp(pixel, vec2i(0), vec2i(textureDimensions(image)) - 1), 0).rgb);
}

// Steps of the search along an edge.
const STEPS: u32 = 10u;

// The length of a step, pixels.
fn step_px(step: u32) -> f32 {
    return select(select(select(select(8.0, 4.0, step < 9u), 2.0, step < 8u), 1.5, step < 5u), 1.0, step < 4u);
}

@fragment
fn fs_fxaa(@location(0) uv: vec2f) -> @location(0) vec4f {
    let texel = 1.0 / vec2f(textureDimensions(image));
    let pixel = vec2i(uv * vec2f(textureDimensions(image)));
    let center = textureLoad(image, pixel, 0);
    let m = luma(center.rgb);
    let n = luma_of(pixel + vec2i(0, -1));
    let s = luma_of(pixel + vec2i(0, 1));
    let w = luma_of(pixel + vec2i(-1, 0));
    let e = luma_of(pixel + vec2i(1, 0));
    let high = max(m, max(max(n, s), max(w, e)));
    let low = min(m, min(min(n, s), min(w, e)));
    let range = high - low;
    if range < max(0.0312, high * 0.125) {
        return center;
    }
    let nw = luma_of(pixel + vec2i(-1, -1));
    let se = luma_of(pixel + vec2i(1, 1));
    let ne = luma_of(pixel + vec2i(1, -1));
    let sw = luma_of(pixel + vec2i(-1, 1));
    let across = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
    let down = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
    let horizontal = across >= down;
    let width = select(texel.x, texel.y, horizontal);
    let first = select(w, n, horizontal);
    let second = select(e, s, horizontal);
    let toward_first = abs(first - m) >= abs(second - m);
    let side = select(width, -width, toward_first);
    let gradient = 0.25 * max(abs(first - m), abs(second - m));
    let middle = 0.5 * (m + select(second, first, toward_first));
    // Search along the edge, half a texel off the pixel, in both directions to its ends.
    let edge_uv = select(vec2f(side * 0.5, 0.0), vec2f(0.0, side * 0.5), horizontal);
    let along = select(vec2f(0.0, texel.y), vec2f(texel.x, 0.0), horizontal);
    let begin = uv + edge_uv;
    // Towards smaller and larger coordinates: the distance, pixels, the difference of luma there, and whether it is the end.
    var px = vec2f(0.0);
    var differences = vec2f(0.0);
    var is_end = vec2<bool>(false);
    var step = 0u;
    loop {
        let next = select(px + step_px(step), px, is_end);
        differences = vec2f(luma_at(begin - along * next.x), luma_at(begin + along * next.y)) - middle;
        px = next;
        is_end = abs(differences) >= vec2f(gradient);
        step++;
        if step >= STEPS || all(is_end) {
            break;
        }
    }
    let difference = select(differences.y, differences.x, px.x < px.y);
    let rising = (difference < 0.0) != (m < middle);
    let edge_shift = select(0.0, 0.5 - min(px.x, px.y) / (px.x + px.y), rising);
    // Single pixels have no edge: they are smoothed by how much they differ from their neighbours.
    let average = (2.0 * (n + s + w + e) + nw + ne + sw + se) / 12.0;
    let subpixel = smoothstep(0.0, 1.0, saturate(abs(average - m) / range));
    let shift = max(edge_shift, subpixel * subpixel * 0.75) * side;
    let at = uv + select(vec2f(shift, 0.0), vec2f(0.0, shift), horizontal);
    return textureSampleLevel(image, linear, at, 0.0);
}
