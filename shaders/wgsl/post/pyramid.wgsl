// The first level of a depth pyramid: the depth itself.
@group(0) @binding(0) var depth_texture: texture_depth_2d;

@fragment
fn fs_begin(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return vec4f(textureLoad(depth_texture, vec2u(position.xy), 0));
}
