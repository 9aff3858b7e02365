// The pool of physical pages as a shadow map: it replaces the module of the maps of cascades and the atlas. The map is the page that is read:
// coordinates are those of the page with its border, so that results do not depend on its place in the pool.
#define_import_path shadowgraph::shadows::maps
#import shadowgraph::shadows::page_depths::{LAST_STEP, PageDepths, compared_step, depth_of_step}
#import shadowgraph::shadows::pages::PAGE_PX
#import shadowgraph::tint_density::density_transmittance

// Steps of depth, the last ones nearest to the light. Width and height are powers of two: texture coordinates of texels are exact.
@group(1) @binding(4) var page_pool: texture_depth_2d;
// Of all texels of a page, one page after the other: the depth of the translucent caster nearest to the light, and the density of those that
// opaque ones do not hide.
@group(1) @binding(6) var<storage, read> page_tint_depths: array<f32>;
@group(1) @binding(7) var<storage, read> page_tint_densities: array<u32>;

// Steps of a texel to which positions are rounded: with up to 13 bits of whole texels they fit an f32.
const STEPS: f32 = 1024.0;

// The page that is read, its place in the pool, and how it stores depths.
var<private> page_index: u32;
var<private> page_place_px: vec2f;
var<private> page_depths: PageDepths;

fn read_page(index: u32, place_px: vec2f, depths: PageDepths) {
    page_index = index;
    page_place_px = place_px;
    page_depths = depths;
}

fn map_size(map: u32) -> vec2f {
    return vec2f(f32(PAGE_PX));
}

fn compared_in(map: u32, comparison: sampler_comparison, uv: vec2f, depth: f32) -> f32 {
    let texel = round(uv * f32(PAGE_PX) * STEPS) / STEPS;
    let pool_uv = (texel + page_place_px) / vec2f(textureDimensions(page_pool));
    return textureSampleCompareLevel(page_pool, comparison, pool_uv, compared_step(page_depths, depth) / LAST_STEP);
}

fn stored_depth(map: u32, texel: vec2i) -> f32 {
    return depth_of_step(page_depths, round(LAST_STEP * textureLoad(page_pool, texel + vec2i(page_place_px), 0)));
}

fn tint_texel(texel: vec2i) -> u32 {
    return (page_index * PAGE_PX + u32(texel.y)) * PAGE_PX + u32(texel.x);
}

fn stored_tint(map: u32, texel: vec2i) -> vec3f {
    return density_transmittance(page_tint_densities[tint_texel(texel)]);
}

fn stored_tint_depth(map: u32, texel: vec2i) -> f32 {
    return page_tint_depths[tint_texel(texel)];
}

// The gradient of the stored depth at a point, per texel, for gradient biases.
fn stored_gradient(map: u32, uv: vec2f) -> f32 {
    let at = vec2i(floor(uv * map_size(map)));
    let across = stored_depth(map, at + vec2i(1, 0)) - stored_depth(map, at - vec2i(1, 0));
    let down = stored_depth(map, at + vec2i(0, 1)) - stored_depth(map, at - vec2i(0, 1));
    return 0.5 * length(vec2f(across, down));
}
