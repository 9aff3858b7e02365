// A picture with colours over it that are stored as they are to be seen.
@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var colors: texture_2d<f32>;
@group(0) @binding(2) var<uniform> strength: f32;

fn to_linear(seen: vec3f) -> vec3f {
    return select(pow((seen + 0.055) / 1.055, vec3f(2.4)), seen / 12.92, seen <= vec3f(0.04045));
}

@fragment
fn fs_overlay(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let own = textureLoad(picture, vec2u(position.xy), 0);
    let over = textureLoad(colors, vec2u(position.xy), 0);
    return vec4f(mix(own.rgb, to_linear(over.rgb), strength * over.a), own.a);
}
