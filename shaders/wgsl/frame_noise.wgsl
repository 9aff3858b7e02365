// The noise of a frame. Where a temporal node averages frames it is spatiotemporal blue noise (Wolfe et al., "Spatiotemporal Blue
// Noise Masks", 2022): every frame brings other values, neighbouring pixels differ, and the values of a pixel soon cover 0 to 1
// evenly. Without such a node it is the same in every frame.
#define_import_path shadowgraph::frame_noise
#import shadowgraph::view::view
#import shadowgraph::noise::pixel_noise
#import shadowgraph::receiver::RECEIVER_NOISE

// The side of the square that repeats over the image, pixels.
const SIDE: u32 = 32u;

fn changes() -> bool {
    return view.noise_changes == 1u;
}

// 0 to 255.
fn byte_at(pixel: vec2f) -> u32 {
    let at = vec2u(pixel) % SIDE;
    let index = at.y * SIDE + at.x;
    return (view.noise[index / 16u][(index / 4u) % 4u] >> (8u * (index % 4u))) & 255u;
}

// 0 to below 1.
fn frame_noise(pixel: vec2f) -> f32 {
    if changes() {
        return (f32(byte_at(pixel)) + 0.5) / 256.0;
    }
    return pixel_noise(pixel);
}

// The bits that give a receiver the noise of its pixel; 0 if it does not change from frame to frame.
fn noise_flags(pixel: vec2f) -> u32 {
    if changes() {
        return RECEIVER_NOISE | (byte_at(pixel) << 24u);
    }
    return 0u;
}
