@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var linear: sampler;
@group(0) @binding(2) var<uniform> tint: vec4f;

@fragment fn grade(@location(0) uv: vec2f) -> @location(0) vec4f {
    let dark = 1.0 - 0.8 * dot(uv - 0.5, uv - 0.5);
    return vec4f(textureSampleLevel(image, linear, uv, 0.0).rgb * dark * tint.rgb, 1.0);
}
