// Views that the GPU writes, each for a layer of depth.
#define_import_path shadowgraph::layer_views

// 80 bytes.
struct LayerView {
    // To the layer: x and y -w to w, y up, z/w 1 nearest and 0 farthest.
    clip_from_world: mat4x4f,
    // Offset from a pixel of the layer to its world-aligned texel, modulo 1024.
    noise_px: vec2u,
    // Whatever the writer needs.
    tag: u32,
    padding: u32,
}

struct LayerViews {
    // The number of views.
    count: u32,
    // The number of those that are drawn, the first ones: fewer where the lists of instances are full. The pass that culls writes it.
    drawn: u32,
    // Width and height of each layer.
    side_px: u32,
    padding: u32,
    views: array<LayerView>,
}
