// The next level of a pyramid of depth.
@group(0) @binding(0) var finer: texture_2d<f32>;

// Reversed depth: the farthest is the least. Where a level has an odd size, its last texels count for the last one of the next.
@fragment
fn fs_halve(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let size = textureDimensions(finer);
    let first = vec2u(position.xy) * 2u;
    let last_of_next = max(size / 2u, vec2u(1u)) - 1u;
    let more = select(vec2u(1u), size - 1u - first, vec2u(position.xy) == last_of_next);
    var farthest = 1.0;
    for (var y = 0u; y <= more.y; y++) {
        for (var x = 0u; x <= more.x; x++) {
            farthest = min(farthest, textureLoad(finer, first + vec2u(x, y), 0).r);
        }
    }
    return vec4f(farthest);
}
