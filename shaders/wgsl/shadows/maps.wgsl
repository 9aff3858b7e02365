// The shadow maps of a frame: depth, 1 nearest to the light, and the tint of light behind translucent casters.
#define_import_path shadowgraph::shadows::maps
#import shadowgraph::shadows::types::MAP_CASCADES
#import shadowgraph::shadows::variant::{ANY_MAP, ONLY_MAP}

@group(1) @binding(2) var cascade_map: texture_depth_2d;
@group(1) @binding(3) var atlas_map: texture_depth_2d;
// The product of the transmittances of translucent casters that are not behind opaque ones.
@group(1) @binding(4) var cascade_tints: texture_2d<f32>;
@group(1) @binding(5) var atlas_tints: texture_2d<f32>;
// Depth of the translucent caster nearest to the light.
@group(1) @binding(6) var cascade_tint_depths: texture_depth_2d;
@group(1) @binding(7) var atlas_tint_depths: texture_depth_2d;

// Whether a map, MAP_*, is that of cascades.
fn is_cascade_map(map: u32) -> bool {
    return select(ONLY_MAP, map, ONLY_MAP == ANY_MAP) == MAP_CASCADES;
}

// The size of a map in texels. `map`: MAP_*.
fn map_size(map: u32) -> vec2f {
    if is_cascade_map(map) {
        return vec2f(textureDimensions(cascade_map));
    }
    return vec2f(textureDimensions(atlas_map));
}

// The comparison of a depth at texture coordinates with those of a map.
fn compared_in(map: u32, comparison: sampler_comparison, uv: vec2f, depth: f32) -> f32 {
    if is_cascade_map(map) {
        return textureSampleCompareLevel(cascade_map, comparison, uv, depth);
    }
    return textureSampleCompareLevel(atlas_map, comparison, uv, depth);
}

fn stored_depth(map: u32, texel: vec2i) -> f32 {
    if is_cascade_map(map) {
        return textureLoad(cascade_map, texel, 0);
    }
    return textureLoad(atlas_map, texel, 0);
}

fn stored_tint(map: u32, texel: vec2i) -> vec3f {
    if is_cascade_map(map) {
        return textureLoad(cascade_tints, texel, 0).rgb;
    }
    return textureLoad(atlas_tints, texel, 0).rgb;
}

fn stored_tint_depth(map: u32, texel: vec2i) -> f32 {
    if is_cascade_map(map) {
        return textureLoad(cascade_tint_depths, texel, 0);
    }
    return textureLoad(atlas_tint_depths, texel, 0);
}

// The gradient of the stored depth at a point, per texel, for gradient biases.
fn stored_gradient(map: u32, uv: vec2f) -> f32 {
    let size_px = map_size(map);
    let at = vec2i(clamp(floor(uv * size_px), vec2f(1.0), size_px - 2.0));
    let across = stored_depth(map, at + vec2i(1, 0)) - stored_depth(map, at - vec2i(1, 0));
    let down = stored_depth(map, at + vec2i(0, 1)) - stored_depth(map, at - vec2i(0, 1));
    return 0.5 * length(vec2f(across, down));
}
