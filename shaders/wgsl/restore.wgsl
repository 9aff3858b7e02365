// Copies a tile of the store of static casters' depth into the map: depth can be copied only by whole layers otherwise.
#import shadowgraph::fullscreen::fullscreen_vertex

struct Restore {
    // Left, top, width, height.
    tile_px: vec4u,
    // Where the tile begins in the store, which wraps around.
    wrap_px: vec2u,
}

@group(0) @binding(0) var store: texture_depth_2d;
@group(0) @binding(1) var<uniform> restore: Restore;

// Depth 0, the far end.
@vertex
fn vs_restore(@builtin(vertex_index) vertex_index: u32) -> @builtin(position) vec4f {
    return fullscreen_vertex(vertex_index).position;
}

@fragment
fn fs_restore(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    let corner = restore.tile_px.xy;
    let at = (vec2u(position.xy) - corner + restore.wrap_px) % restore.tile_px.zw;
    return textureLoad(store, corner + at, 0);
}
