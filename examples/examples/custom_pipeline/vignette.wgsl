@group(0) @binding(0) var light: texture_2d<f32>;
@group(0) @binding(1) var<uniform> strength: f32;

@fragment
fn vignette(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
    let from_center = length(uv * 2.0 - 1.0);
    return textureLoad(light, vec2u(position.xy), 0) * (1.0 - strength * smoothstep(0.5, 1.4, from_center));
}
