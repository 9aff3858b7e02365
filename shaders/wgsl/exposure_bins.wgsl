// The bins of brightness for automatic exposure: 8 per factor of two.
#define_import_path shadowgraph::exposure_bins

const BINS: u32 = 128u;
const BINS_PER_STOP: f32 = 8.0;
// The logarithm of the brightness at which the first bin begins.
const FIRST_STOP: f32 = -10.0;

fn bin_of(brightness: f32) -> u32 {
    let bin = (log2(max(brightness, 1e-6)) - FIRST_STOP) * BINS_PER_STOP;
    return u32(clamp(bin, 0.0, f32(BINS - 1u)));
}

// The brightness at the middle of a bin.
fn brightness_of(bin: f32) -> f32 {
    return exp2((bin + 0.5) / BINS_PER_STOP + FIRST_STOP);
}
