// Converts a depth map to a moment map: averages moments over a texel and blurs them with a separable tent; then downsamples
// the result repeatedly. Tiles are never mixed.
#import shadowgraph::shadows::types::ShadowView
#import shadowgraph::shadows::linear_depth::linear_depth
#import shadowgraph::shadows::encoding::{MomentSettings, moments_of, packed, unpacked}

@group(0) @binding(0) var<storage, read> shadow_views: array<ShadowView>;
// The views of the map's tiles.
@group(0) @binding(1) var<storage, read> tiles: array<u32>;
@group(0) @binding(2) var<uniform> settings: MomentSettings;

@group(1) @binding(0) var depth_map: texture_depth_2d;
@group(1) @binding(1) var halfway: texture_storage_2d<rgba32float, write>;

@group(1) @binding(0) var blurred: texture_2d<f32>;
// FORMAT is replaced by the format of the encoding.
@group(1) @binding(1) var moments: texture_storage_2d<FORMAT, write>;

@group(1) @binding(0) var finer: texture_2d<u32>;

const NO_TILE: u32 = 0xffffffffu;

// The index of the tile of a texel.
fn tile_at(texel: vec2u) -> u32 {
    for (var i = 0u; i < arrayLength(&tiles); i++) {
        let rect = shadow_views[tiles[i]].tile_px / settings.downscale;
        // Left of or above the tile the difference wraps to a large number.
        if all(texel - rect.xy < rect.zw) {
            return i;
        }
    }
    return NO_TILE;
}

// The weight of a texel at an offset from the centre.
fn tent(offset: i32) -> f32 {
    let width = f32(settings.blur_texels + 1u);
    return (width - abs(f32(offset))) / (width * width);
}

// The mean of the moments of all depths that a texel covers.
fn resolved(shadow_view: ShadowView, texel: vec2u) -> vec4f {
    var sum = vec4f(0.0);
    for (var y = 0u; y < settings.downscale; y++) {
        for (var x = 0u; x < settings.downscale; x++) {
            let depth = textureLoad(depth_map, texel * settings.downscale + vec2u(x, y), 0);
            sum += moments_of(settings, linear_depth(shadow_view, depth));
        }
    }
    return sum / f32(settings.downscale * settings.downscale);
}

@compute @workgroup_size(8, 8)
fn cs_resolve(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(halfway)) {
        return;
    }
    let tile = tile_at(id.xy);
    if tile == NO_TILE {
        // Outside all tiles the depth is the farthest.
        textureStore(halfway, id.xy, moments_of(settings, 1.0));
        return;
    }
    textureStore(halfway, id.xy, resolved(shadow_views[tiles[tile]], id.xy));
}

// The first and last texel of a texel's row or column in its tile.
fn ends(texel: vec2u, axis: u32) -> vec2i {
    let tile = tile_at(texel);
    if tile == NO_TILE {
        return vec2i(i32(texel[axis]));
    }
    let rect = vec4i(shadow_views[tiles[tile]].tile_px / settings.downscale);
    return vec2i(rect[axis], rect[axis] + rect[axis + 2u] - 1);
}

@compute @workgroup_size(8, 8)
fn cs_across(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(halfway)) {
        return;
    }
    let ends = ends(id.xy, 0u);
    var sum = vec4f(0.0);
    for (var offset = -i32(settings.blur_texels); offset <= i32(settings.blur_texels); offset++) {
        let x = clamp(i32(id.x) + offset, ends.x, ends.y);
        sum += tent(offset) * textureLoad(blurred, vec2u(u32(x), id.y), 0);
    }
    textureStore(halfway, id.xy, sum);
}

@compute @workgroup_size(8, 8)
fn cs_down(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(moments)) {
        return;
    }
    let ends = ends(id.xy, 1u);
    var sum = vec4f(0.0);
    for (var offset = -i32(settings.blur_texels); offset <= i32(settings.blur_texels); offset++) {
        let y = clamp(i32(id.y) + offset, ends.x, ends.y);
        sum += tent(offset) * textureLoad(blurred, vec2u(id.x, u32(y)), 0);
    }
    textureStore(moments, id.xy, packed(sum));
}

// Tiles begin and end at even texels.
@compute @workgroup_size(8, 8)
fn cs_halve(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= textureDimensions(moments)) {
        return;
    }
    var sum = vec4f(0.0);
    for (var i = 0u; i < 4u; i++) {
        sum += unpacked(textureLoad(finer, 2u * id.xy + vec2u(i & 1u, i >> 1u), 0));
    }
    textureStore(moments, id.xy, packed(0.25 * sum));
}
