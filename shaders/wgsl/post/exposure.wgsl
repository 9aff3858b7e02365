// The factor of exposure that suits a histogram of brightness.
#import shadowgraph::exposure_bins::{BINS, brightness_of}

struct Settings {
    // The brightness to which the median is brought.
    key: f32,
    // How much of the way to it, 0 to 1.
    strength: f32,
    // The share of the pixels that may be brighter than `white`.
    highlights: f32,
    white: f32,
    // The least and the largest factor.
    least: f32,
    largest: f32,
    // The weight of this frame; 1 without an earlier one.
    weight: f32,
}

@group(0) @binding(0) var<storage, read> histogram: array<u32, BINS>;
@group(0) @binding(1) var<uniform> settings: Settings;
@group(0) @binding(2) var previous: texture_2d<f32>;

// The brightness that a share of the pixels is below.
fn percentile(share: f32, total: f32) -> f32 {
    var sum = 0.0;
    for (var bin = 0u; bin < BINS; bin++) {
        let count = f32(histogram[bin]);
        if count > 0.0 && sum + count >= share * total {
            return brightness_of(f32(bin) - 0.5 + (share * total - sum) / count);
        }
        sum += count;
    }
    return brightness_of(f32(BINS - 1u));
}

fn exposure_factor() -> f32 {
    var total = 0.0;
    for (var bin = 0u; bin < BINS; bin++) {
        total += f32(histogram[bin]);
    }
    var factor = 1.0;
    if total > 0.0 {
        let median = percentile(0.5, total);
        factor = pow(settings.key / median, settings.strength);
        factor = min(factor, settings.white / percentile(1.0 - settings.highlights, total));
        factor = clamp(factor, settings.least, settings.largest);
    }
    return factor;
}

@fragment
fn fs_exposure() -> @location(0) vec4f {
    return vec4f(exposure_factor(), 0.0, 0.0, 1.0);
}

@fragment
fn fs_exposure_adapted() -> @location(0) vec4f {
    var factor = exposure_factor();
    let before = textureLoad(previous, vec2u(0u), 0).r;
    if settings.weight < 1.0 && before > 0.0 {
        factor = exp2(mix(log2(before), log2(factor), settings.weight));
    }
    return vec4f(factor, 0.0, 0.0, 1.0);
}
