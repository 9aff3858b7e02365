// The filter of techniques with moment maps: the visibility follows from the mean of the moments around a point. The module
// shadowgraph::shadows::encoding defines the moments and the visibility that they give.
#define_import_path shadowgraph::shadows::filter
#import shadowgraph::receiver::Receiver
#import shadowgraph::shadows::encoding::{MomentSettings, unpacked, visibility_of}
#import shadowgraph::shadows::linear_depth::linear_depth
#import shadowgraph::shadows::lookup::Lookup
#import shadowgraph::shadows::maps::is_cascade_map
#import shadowgraph::shadows::types::{ShadowView, ShadowLight}
#import shadowgraph::shadows::views::light_view

// The largest distance of the taps in wide pixels from the centre, along each axis, in texels of the finest mip.
const TAP_TEXELS: f32 = 0.75;

@group(1) @binding(10) var cascade_moments: texture_2d<u32>;
@group(1) @binding(11) var atlas_moments: texture_2d<u32>;
@group(1) @binding(12) var<uniform> settings: MomentSettings;

fn stored(map: u32, texel: vec2i, mip: u32) -> vec4f {
    if is_cascade_map(map) {
        return unpacked(textureLoad(cascade_moments, texel, mip));
    }
    return unpacked(textureLoad(atlas_moments, texel, mip));
}

// Computed from the finest size, whose sides are powers of two: some drivers take the mip of textureDimensions from one pixel
// of a group.
fn size_of(map: u32, mip: u32) -> vec2f {
    if is_cascade_map(map) {
        return vec2f(textureDimensions(cascade_moments) >> vec2u(mip));
    }
    return vec2f(textureDimensions(atlas_moments) >> vec2u(mip));
}

// Bilinear filtering. Points that a tile covers are at least a texel away from its edge.
fn bilinear(map: u32, uv: vec2f, mip: u32) -> vec4f {
    let at = uv * size_of(map, mip) - 0.5;
    let base = floor(at);
    let fraction = at - base;
    let texel = vec2i(base);
    let top = mix(stored(map, texel, mip), stored(map, texel + vec2i(1, 0), mip), fraction.x);
    let bottom = mix(stored(map, texel + vec2i(0, 1), mip), stored(map, texel + vec2i(1, 1), mip), fraction.x);
    return mix(top, bottom, fraction.y);
}

// The mip whose texels are as wide as a pixel of the screen: the geometric mean of both axes.
fn mip_level(shadow_view: ShadowView, receiver: Receiver) -> f32 {
    var distance = 1.0;
    if shadow_view.light.w != 0.0 {
        distance = length(shadow_view.light.xyz - receiver.position);
    }
    let texel_world = shadow_view.texel_world * distance * f32(settings.downscale);
    let pixel_world = sqrt(length(receiver.ddx_position) * length(receiver.ddy_position));
    let texels_per_pixel = pixel_world / max(texel_world, 1e-9);
    return select(0.0, min(log2(texels_per_pixel), f32(settings.mips - 1u)), texels_per_pixel > 1.0);
}

// The radius of the filter where blockers are near, texels of the depth map.
fn filter_radius(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    let level = mip_level(light_view(light, lookup.view), receiver);
    return f32(settings.downscale * (settings.blur_texels + 2u)) * exp2(level);
}

// The visibility of the light from a point: 0 (in shadow) to 1.
fn filtered(light: ShadowLight, receiver: Receiver, lookup: Lookup) -> f32 {
    let shadow_view = light_view(light, lookup.view);
    let level = mip_level(shadow_view, receiver);
    let mip = u32(level);
    // In wide pixels more texels: a moment texel is the mean of few depths, and would change in large steps as the light turns.
    let taps = select(1u, 4u, lookup.min_radius > 0.0);
    let reach_uv = TAP_TEXELS * min(lookup.min_radius, 1.0) / size_of(light.map, 0u);
    var sum = vec4f(0.0);
    var tap = 0u;
    loop {
        let corner = vec2f(f32(tap & 1u), f32(tap >> 1u)) * 2.0 - 1.0;
        let uv = clamp(lookup.uv + corner * reach_uv, shadow_view.uv_min, shadow_view.uv_max);
        var moments = bilinear(light.map, uv, mip);
        if level > f32(mip) {
            moments = mix(moments, bilinear(light.map, uv, mip + 1u), level - f32(mip));
        }
        sum += moments;
        tap++;
        if tap >= taps {
            break;
        }
    }
    // Bias by a quarter of the filter radius for the receiver's plane and for the foot of lit walls; tent filters need more.
    let bias_texels = 0.25 * f32(settings.downscale * (settings.blur_texels + 1u)) * exp2(level);
    let slope = lookup.plane.slope;
    let rise = bias_texels * max(abs(slope.x) + abs(slope.y), lookup.plane.min_slope);
    let depth = min(lookup.plane.depth + rise, 1.0);
    return visibility_of(settings, sum / f32(taps), linear_depth(shadow_view, depth));
}
