// Bloom: the light is downsampled repeatedly, then added up from the smallest level (Jimenez, "Next Generation Post Processing
// in Call of Duty: Advanced Warfare", 2014).

@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var linear: sampler;
// The level of the output before it was downsampled.
@group(0) @binding(2) var finer: texture_2d<f32>;

fn tap(uv: vec2f, offset: vec2f) -> vec3f {
    let texel = 1.0 / vec2f(textureDimensions(source));
    return textureSampleLevel(source, linear, uv + offset * texel, 0.0).rgb;
}

// Weights bright taps down, so that one bright pixel does not flicker as large squares (Karis, "Tone Mapping", 2013).
fn luma_weighted(color: vec3f) -> vec4f {
    let weight = 1.0 / (1.0 + max(color.r, max(color.g, color.b)));
    return vec4f(color, 1.0) * weight;
}

// Thirteen taps: four overlapping squares and one in their middle.
fn downsampled(uv: vec2f, weight_luma: bool) -> vec3f {
    var sum = vec4f(0.0);
    let squares = array(vec3f(0.0, 0.0, 0.5), vec3f(-1.0, -1.0, 0.125), vec3f(1.0, -1.0, 0.125), vec3f(-1.0, 1.0, 0.125), vec3f(1.0, 1.0, 0.125));
    for (var i = 0; i < 5; i++) {
        let square = squares[i];
        var color = tap(uv, square.xy + vec2f(-1.0, -1.0)) + tap(uv, square.xy + vec2f(1.0, -1.0))
            + tap(uv, square.xy + vec2f(-1.0, 1.0)) + tap(uv, square.xy + vec2f(1.0, 1.0));
        color *= 0.25;
        sum += select(vec4f(color, 1.0), luma_weighted(color), weight_luma) * square.z;
    }
    return sum.rgb / sum.a;
}

@fragment
fn fs_first(@location(0) uv: vec2f) -> @location(0) vec4f {
    return vec4f(downsampled(uv, true), 1.0);
}

@fragment
fn fs_downsample(@location(0) uv: vec2f) -> @location(0) vec4f {
    return vec4f(downsampled(uv, false), 1.0);
}

// Half of the level's light, and half of a tent over nine taps of the next smaller level.
@fragment
fn fs_upsample(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    var sum = tap(uv, vec2f(0.0)) * 4.0;
    for (var i = 0; i < 4; i++) {
        let side = f32(i / 2 * 2 - 1);
        let along = select(vec2f(side, 0.0), vec2f(0.0, side), i % 2 == 0);
        let corner = vec2f(side, f32(i % 2 * 2 - 1));
        sum += tap(uv, along) * 2.0 + tap(uv, corner);
    }
    let base = textureLoad(finer, vec2u(position.xy), 0).rgb;
    return vec4f(mix(base, sum / 16.0, 0.5), 1.0);
}
