// Blends the light with its bloom.
@group(0) @binding(0) var light: texture_2d<f32>;
@group(0) @binding(1) var bloom: texture_2d<f32>;
@group(0) @binding(2) var linear: sampler;
@group(0) @binding(3) var<uniform> strength: f32;

@fragment
fn fs_mix(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let base = textureLoad(light, vec2u(position.xy), 0);
    let other = textureSampleLevel(bloom, linear, uv, 0.0).rgb;
    return vec4f(mix(base.rgb, other, strength), base.a);
}
