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

// The texel of an invocation: each layer of workgroups computes a tile.
struct TileTexel {
    shadow_view: ShadowView,
    // First texel and size of the tile.
    rect: vec4u,
    texel: vec2u,
    is_inside: bool,
}

fn tile_texel(id: vec3u) -> TileTexel {
    let shadow_view = shadow_views[tiles[id.z]];
    let rect = shadow_view.tile_px / settings.downscale;
    return TileTexel(shadow_view, rect, rect.xy + id.xy, all(id.xy < rect.zw));
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
    let at = tile_texel(id);
    if at.is_inside {
        textureStore(halfway, at.texel, resolved(at.shadow_view, at.texel));
    }
}

@compute @workgroup_size(8, 8)
fn cs_across(@builtin(global_invocation_id) id: vec3u) {
    let at = tile_texel(id);
    if !at.is_inside {
        return;
    }
    var sum = vec4f(0.0);
    for (var offset = -i32(settings.blur_texels); offset <= i32(settings.blur_texels); offset++) {
        let x = clamp(i32(at.texel.x) + offset, i32(at.rect.x), i32(at.rect.x + at.rect.z) - 1);
        sum += tent(offset) * textureLoad(blurred, vec2u(u32(x), at.texel.y), 0);
    }
    textureStore(halfway, at.texel, sum);
}

@compute @workgroup_size(8, 8)
fn cs_down(@builtin(global_invocation_id) id: vec3u) {
    let at = tile_texel(id);
    if !at.is_inside {
        return;
    }
    var sum = vec4f(0.0);
    for (var offset = -i32(settings.blur_texels); offset <= i32(settings.blur_texels); offset++) {
        let y = clamp(i32(at.texel.y) + offset, i32(at.rect.y), i32(at.rect.y + at.rect.w) - 1);
        sum += tent(offset) * textureLoad(blurred, vec2u(at.texel.x, u32(y)), 0);
    }
    textureStore(moments, at.texel, packed(sum));
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
