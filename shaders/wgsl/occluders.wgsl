// Where the buffer of a depth pyramid has its texels. A texel of level n is the farthest depth of 2^n by 2^n pixels, or of those inside the
// image. Level FINEST comes first, in rows; the coarser ones are to the right of it, one below the other.
#define_import_path shadowgraph::occluders

// The finest level.
const FINEST: u32 = 2u;

// The level that is one texel.
fn top_level(size_px: vec2u) -> u32 {
    return max(32u - countLeadingZeros(max(size_px.x, size_px.y) - 1u), FINEST);
}

fn level_size(size_px: vec2u, level: u32) -> vec2u {
    return (size_px + ((1u << level) - 1u)) >> vec2u(level);
}

// The index of a texel.
fn texel_index(size_px: vec2u, level: u32, texel: vec2u) -> u32 {
    let widths = vec2u(level_size(size_px, FINEST).x, level_size(size_px, FINEST + 1u).x);
    // Below the height as a power of two; an additional row for each level, as none has less than one.
    let height = 1u << (32u - countLeadingZeros(size_px.y - 1u));
    let row = (height >> FINEST) - (height >> (level - 1u)) + level - FINEST - 1u;
    let first = select(row * (widths.x + widths.y) + widths.x, 0u, level == FINEST);
    return first + texel.y * (widths.x + widths.y) + texel.x;
}
