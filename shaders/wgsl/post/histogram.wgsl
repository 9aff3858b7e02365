// The histogram of the image's brightness, for automatic exposure.
#import shadowgraph::exposure_bins::{BINS, bin_of}

@group(0) @binding(0) var light: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> histogram: array<atomic<u32>, BINS>;

var<workgroup> shared_bins: array<atomic<u32>, BINS>;

@compute @workgroup_size(16, 8)
fn cs_histogram(@builtin(global_invocation_id) id: vec3u, @builtin(local_invocation_index) index: u32) {
    atomicStore(&shared_bins[index], 0u);
    workgroupBarrier();
    let size = textureDimensions(light);
    // Each invocation counts four pixels, one below the other.
    for (var row = 0u; row < 4u; row++) {
        let texel = vec2u(id.x, id.y * 4u + row);
        if all(texel < size) {
            let color = textureLoad(light, texel, 0);
            let brightest = max(color.r, max(color.g, color.b));
            // Where alpha is less than 1, black is nothing, or a shadow on it.
            if color.a >= 1.0 || (color.a > 0.0 && brightest > 0.0) {
                atomicAdd(&shared_bins[bin_of(brightest / min(color.a, 1.0))], 1u);
            }
        }
    }
    workgroupBarrier();
    let count = atomicLoad(&shared_bins[index]);
    if count > 0u {
        atomicAdd(&histogram[index], count);
    }
}
