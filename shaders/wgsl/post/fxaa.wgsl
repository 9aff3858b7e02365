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

const STEPS: array<f32, 10> = array(1.0, 1.0, 1.0, 1.0, 1.5, 2.0, 2.0, 2.0, 4.0, 8.0);

@fragment
fn fs_fxaa(@location(0) uv: vec2f) -> @location(0) vec4f {
    let texel = 1.0 / vec2f(textureDimensions(image));
    let center = textureSampleLevel(image, linear, uv, 0.0);
    let m = luma(center.rgb);
    let n = luma_at(uv + vec2f(0.0, -texel.y));
    let s = luma_at(uv + vec2f(0.0, texel.y));
    let w = luma_at(uv + vec2f(-texel.x, 0.0));
    let e = luma_at(uv + vec2f(texel.x, 0.0));
    let high = max(m, max(max(n, s), max(w, e)));
    let low = min(m, min(min(n, s), min(w, e)));
    let range = high - low;
    if range < max(0.0312, high * 0.125) {
        return center;
    }
    let nw = luma_at(uv - texel);
    let se = luma_at(uv + texel);
    let ne = luma_at(uv + vec2f(texel.x, -texel.y));
    let sw = luma_at(uv + vec2f(-texel.x, texel.y));
    let across = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
    let down = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
    let horizontal = across >= down;
    let step = select(texel.x, texel.y, horizontal);
    let first = select(w, n, horizontal);
    let second = select(e, s, horizontal);
    let toward_first = abs(first - m) >= abs(second - m);
    let side = select(step, -step, toward_first);
    let gradient = 0.25 * max(abs(first - m), abs(second - m));
    let middle = 0.5 * (m + select(second, first, toward_first));
    // Search along the edge, half a texel off the pixel, in both directions to its ends.
    let edge_uv = select(vec2f(side * 0.5, 0.0), vec2f(0.0, side * 0.5), horizontal);
    let along = select(vec2f(0.0, texel.y), vec2f(texel.x, 0.0), horizontal);
    var ends = array(uv + edge_uv, uv + edge_uv);
    var ends_luma = array(0.0, 0.0);
    var done = array(false, false);
    for (var i = 0; i < 10; i++) {
        for (var end = 0; end < 2; end++) {
            if !done[end] {
                ends[end] += along * STEPS[i] * (f32(end) * 2.0 - 1.0);
                ends_luma[end] = luma_at(ends[end]) - middle;
                done[end] = abs(ends_luma[end]) >= gradient;
            }
        }
    }
    let distances = array(
        select(uv.y - ends[0].y, uv.x - ends[0].x, horizontal),
        select(ends[1].y - uv.y, ends[1].x - uv.x, horizontal),
    );
    let nearest = select(1, 0, distances[0] < distances[1]);
    let rising = (ends_luma[nearest] < 0.0) != (m < middle);
    let edge_shift = select(0.0, 0.5 - distances[nearest] / (distances[0] + distances[1]), rising);
    // Single pixels have no edge: they are smoothed by how much they differ from their neighbours.
    let average = (2.0 * (n + s + w + e) + nw + ne + sw + se) / 12.0;
    let subpixel = smoothstep(0.0, 1.0, saturate(abs(average - m) / range));
    let shift = max(edge_shift, subpixel * subpixel * 0.75) * side;
    let at = uv + select(vec2f(shift, 0.0), vec2f(0.0, shift), horizontal);
    return textureSampleLevel(image, linear, at, 0.0);
}
