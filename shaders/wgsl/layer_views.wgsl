// Views that the GPU writes, each for a layer of depth. Casters are drawn into them by implementations of LayeredCasters, which says how;
// cull_layers.wgsl and depth_layers.wgsl are one.
#define_import_path shadowgraph::layer_views

// The casters of a view: CASTERS_*.
const CASTERS_STATIC: u32 = 1u;
const CASTERS_MOVING: u32 = 2u;

// 96 bytes.
struct LayerView {
    // From positions relative to the frame's origin to the layer: x and y -w to w, y up, z/w 1 nearest and 0 farthest.
    clip_from_world: mat4x4f,
    // Offset from a pixel of the layer to its world-aligned texel, modulo 1024.
    noise_px: vec2u,
    // Whatever the writer needs.
    tag: vec2u,
    // The casters that are drawn: the sum of CASTERS_*.
    casters: u32,
    // The layer of the buffers of tints, which can outlive those of depths.
    tint_layer: u32,
    // The bias of depths away from the light, relative to their slope.
    slope_bias: f32,
    padding: u32,
}

struct LayerViews {
    // The number of views.
    count: u32,
    // The number of those that are drawn, the first ones: fewer where the lists of instances are full. The pass that culls writes it.
    drawn: u32,
    // Width and height of each layer.
    side_px: u32,
    // The number of pairs of an instance and a view that are drawn. The pass that culls writes it.
    pairs: u32,
    // The casters of all views: the sum of CASTERS_*. Others are not tested.
    casters: u32,
    padding: array<u32, 3>,
    views: array<LayerView>,
}
