// Builds a depth pyramid in a buffer.
//
//   fine_levels     levels FINEST to FINEST + 4, from a depth texture: a tile of 64 by 64 pixels for each workgroup
//   coarse_levels   the others, from those: one workgroup
//
// Depth is reversed: the farthest is the smallest.
#import shadowgraph::occluders::{FINEST, level_size, texel_index, top_level}

@group(0) @binding(0) var depth_texture: texture_depth_2d;
@group(0) @binding(1) var<storage, read_write> occluders: array<f32>;

// Texels of a tile, in x and y, at level FINEST.
const TILE: u32 = 16u;
// Threads of coarse_levels.
const THREADS: u32 = 256u;

var<workgroup> farthest: array<array<f32, TILE>, TILE>;

@compute @workgroup_size(16, 16)
fn fine_levels(@builtin(workgroup_id) tile: vec3u, @builtin(local_invocation_id) local: vec3u) {
    let size_px = textureDimensions(depth_texture);
    let first_px = (TILE * tile.xy + local.xy) << vec2u(FINEST);
    var depth = 1.0;
    for (var y = 0u; y < (1u << FINEST); y++) {
        for (var x = 0u; x < (1u << FINEST); x++) {
            // Outside, a pixel at the edge: it belongs to every texel with a pixel inside.
            depth = min(depth, textureLoad(depth_texture, min(first_px + vec2u(x, y), size_px - 1u), 0));
        }
    }
    store(size_px, FINEST, TILE * tile.xy + local.xy, depth);
    for (var level = FINEST + 1u; level <= FINEST + 4u; level++) {
        farthest[local.y][local.x] = depth;
        workgroupBarrier();
        let width = TILE >> (level - FINEST);
        if all(local.xy < vec2u(width)) {
            let child = 2u * local.xy;
            let upper = min(farthest[child.y][child.x], farthest[child.y][child.x + 1u]);
            depth = min(upper, min(farthest[child.y + 1u][child.x], farthest[child.y + 1u][child.x + 1u]));
            store(size_px, level, width * tile.xy + local.xy, depth);
        }
        workgroupBarrier();
    }
}

@compute @workgroup_size(256)
fn coarse_levels(@builtin(local_invocation_index) local: u32) {
    let size_px = textureDimensions(depth_texture);
    for (var level = FINEST + 5u; level <= top_level(size_px); level++) {
        let size = level_size(size_px, level);
        let last = level_size(size_px, level - 1u) - 1u;
        for (var index = local; index < size.x * size.y; index += THREADS) {
            let texel = vec2u(index % size.x, index / size.x);
            var depth = 1.0;
            for (var child = 0u; child < 4u; child++) {
                let finer = min(2u * texel + vec2u(child & 1u, child >> 1u), last);
                depth = min(depth, occluders[texel_index(size_px, level - 1u, finer)]);
            }
            store(size_px, level, texel, depth);
        }
        storageBarrier();
    }
}

// Stores a texel, if it is in the image.
fn store(size_px: vec2u, level: u32, texel: vec2u, depth: f32) {
    if all(texel < level_size(size_px, level)) {
        occluders[texel_index(size_px, level, texel)] = depth;
    }
}
