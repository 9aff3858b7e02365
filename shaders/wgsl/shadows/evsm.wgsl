// The moments of the technique `evsm`: depth and its square, warped by two exponentials, one that grows away from the light and
// one that grows towards it (Lauritzen and McCool, "Layered Variance Shadow Maps", 2008; Annen et al., "Exponential Shadow Maps",
// 2008). Chebyshev's inequality bounds the fraction of the filter that is farther away than the point.
#define_import_path shadowgraph::shadows::encoding
#import shadowgraph::shadows::evsm_layout::{FOUR, HALF}

// The settings of the technique.
struct MomentSettings {
    // Exponents of the warps away from the light and towards it.
    positive_exponent: f32,
    negative_exponent: f32,
    // The fraction of visibility that is treated as light bleeding.
    bleed: f32,
    // The difference of depths that count as equal, as a fraction of the tile's range.
    bias: f32,
    // Depth texels per moment texel along each axis.
    downscale: u32,
    // Blur radius in moment texels.
    blur_texels: u32,
    mips: u32,
}

// `depth`: 0 nearest to the light, 1 farthest.
fn warped(settings: MomentSettings, depth: f32) -> vec2f {
    let centred = 2.0 * saturate(depth) - 1.0;
    return vec2f(exp(settings.positive_exponent * centred), -exp(-settings.negative_exponent * centred));
}

fn moments_of(settings: MomentSettings, depth: f32) -> vec4f {
    let warp = warped(settings, depth);
    return vec4f(warp, warp * warp).xzyw;
}

// The encoding in a texel.
fn packed(moments: vec4f) -> vec4u {
    if HALF {
        // The largest half float is 65504.
        let clamped = clamp(moments, vec4f(-65504.0), vec4f(65504.0));
        return vec4u(pack2x16float(clamped.xy), pack2x16float(clamped.zw), 0u, 0u);
    }
    return bitcast<vec4u>(moments);
}

fn unpacked(texel: vec4u) -> vec4f {
    if HALF {
        return vec4f(unpack2x16float(texel.x), unpack2x16float(texel.y));
    }
    return bitcast<vec4f>(texel);
}

fn chebyshev(moments: vec2f, depth: f32, min_variance: f32, bleed: f32) -> f32 {
    if depth <= moments.x {
        return 1.0;
    }
    let variance = max(moments.y - moments.x * moments.x, min_variance);
    let offset = depth - moments.x;
    let bound = variance / (variance + offset * offset);
    return saturate((bound - bleed) / (1.0 - bleed));
}

fn visibility_of(settings: MomentSettings, moments: vec4f, depth: f32) -> f32 {
    let warp = warped(settings, depth);
    // Depths this close count as equal, on the curve of each warp.
    let exponents = vec2f(settings.positive_exponent, settings.negative_exponent);
    let close = settings.bias * exponents * warp;
    let min_variances = close * close;
    let visibility = chebyshev(moments.xy, warp.x, min_variances.x, settings.bleed);
    if FOUR {
        return min(visibility, chebyshev(moments.zw, warp.y, min_variances.y, settings.bleed));
    }
    return visibility;
}
