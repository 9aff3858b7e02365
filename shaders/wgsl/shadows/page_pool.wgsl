// The pool of physical pages as a shadow map: it replaces the module of the maps of cascades and the atlas.
#define_import_path shadowgraph::shadows::maps

// Depth, 1 nearest to the light.
@group(1) @binding(4) var page_pool: texture_depth_2d;

fn map_size(map: u32) -> vec2f {
    return vec2f(textureDimensions(page_pool));
}

fn compared_in(map: u32, comparison: sampler_comparison, uv: vec2f, depth: f32) -> f32 {
    return textureSampleCompareLevel(page_pool, comparison, uv, depth);
}

fn stored_depth(map: u32, texel: vec2i) -> f32 {
    return textureLoad(page_pool, texel, 0);
}

// The gradient of the stored depth at a point, per texel, for gradient biases.
fn stored_gradient(map: u32, uv: vec2f) -> f32 {
    let at = vec2i(floor(uv * map_size(map)));
    let across = stored_depth(map, at + vec2i(1, 0)) - stored_depth(map, at - vec2i(1, 0));
    let down = stored_depth(map, at + vec2i(0, 1)) - stored_depth(map, at - vec2i(0, 1));
    return 0.5 * length(vec2f(across, down));
}
