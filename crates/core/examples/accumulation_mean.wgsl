@group(0) @binding(0) var present: texture_2d<f32>;
@group(0) @binding(1) var before: texture_2d<f32>;
@group(0) @binding(2) var<uniform> frame: vec4u;

// `frame.x` is the number of earlier frames; 0 if the history is not valid.
@fragment fn mean(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let old = textureLoad(before, vec2u(at.xy), 0);
    return mix(old, textureLoad(present, vec2u(at.xy), 0), 1.0 / f32(frame.x + 1u));
}

@fragment fn side_by_side(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let size = textureDimensions(present);
    let pixel = vec2u(at.xy);
    if pixel.x < size.x {
        return textureLoad(present, pixel, 0);
    }
    return textureLoad(before, pixel - vec2u(size.x, 0u), 0);
}
