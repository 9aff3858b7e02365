// The next level of a depth pyramid.
@group(0) @binding(0) var finer: texture_2d<f32>;

// Depth is reversed: the farthest is the smallest. If a level has an odd size, its last texels belong to the last one of the
// next level.
@fragment
fn fs_downsample(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = textureDimensions(finer);
    let first = vec2u(position.xy) * 2u;
    let last_of_next = max(size / 2u, vec2u(1u)) - 1u;
    let extra = select(vec2u(1u), size - 1u - first, vec2u(position.xy) == last_of_next);
    var farthest = 1.0;
    for (var y = 0u; y <= extra.y; y++) {
        for (var x = 0u; x <= extra.x; x++) {
            farthest = min(farthest, textureLoad(finer, first + vec2u(x, y), 0).r);
        }
    }
    return vec4f(farthest);
}
