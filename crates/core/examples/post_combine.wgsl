@group(0) @binding(0) var source: texture_2d<f32>;
@group(0) @binding(1) var glow: texture_2d<f32>;
@group(0) @binding(2) var linear: sampler;

@fragment fn combine(@location(0) uv: vec2f) -> @location(0) vec4f {
    let color = textureSampleLevel(source, linear, uv, 0.0).rgb
        + 2.0 * textureSampleLevel(glow, linear, uv, 0.0).rgb;
    return vec4f(1.0 - exp(-color), 1.0);
}
