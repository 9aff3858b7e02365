// An image with an overlay whose colours are stored display-encoded.
@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var overlay: texture_2d<f32>;
@group(0) @binding(2) var<uniform> strength: f32;

fn to_linear(encoded: vec3f) -> vec3f {
    return select(pow((encoded + 0.055) / 1.055, vec3f(2.4)), encoded / 12.92, encoded <= vec3f(0.04045));
}

@fragment
fn fs_overlay(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let base = textureLoad(image, vec2u(position.xy), 0);
    let color = textureLoad(overlay, vec2u(position.xy), 0);
    return vec4f(mix(base.rgb, to_linear(color.rgb), strength * color.a), base.a);
}
