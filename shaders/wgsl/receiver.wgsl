// A point at which a technique evaluates visibility.
#define_import_path shadowgraph::receiver
#import shadowgraph::noise::pixel_noise

// The surface is blended with what is behind it.
const RECEIVER_TRANSPARENT: u32 = 1u;
// The surface was seen from behind and its normals were flipped towards the viewer.
const RECEIVER_BACK_FACE: u32 = 2u;
// The point is not the surface visible at `pixel`, so screen-space results do not apply to it.
const RECEIVER_OFF_SCREEN: u32 = 4u;
// Read the next coarser map that covers the point, if there is one. For measurements.
const RECEIVER_COARSER: u32 = 8u;
// The eight highest bits of the flags are the noise of the frame at this pixel.
const RECEIVER_NOISE: u32 = 16u;

struct Receiver {
    // Metres relative to the frame's origin.
    position: vec3f,
    // Metres in front of the camera.
    view_depth: f32,
    // Normal of the triangle, towards the viewer, unit length.
    geometric_normal: vec3f,
    // RECEIVER_* bits, and noise in the eight highest.
    flags: u32,
    // Interpolated and normal-mapped normal, unit length.
    shading_normal: vec3f,
    // Pixel centre in the target: (0.5, 0.5) is the first.
    pixel: vec2f,
    // Change of position to the next pixel right and down on the surface's plane, metres; 0 at points that are not on a surface.
    ddx_position: vec3f,
    ddy_position: vec3f,
}

// Noise for sample patterns, 0 to below 1: that of the frame where it changes, else that of the pixel.
fn receiver_noise(receiver: Receiver) -> f32 {
    if (receiver.flags & RECEIVER_NOISE) != 0u {
        return (f32(receiver.flags >> 24u) + 0.5) / 256.0;
    }
    return pixel_noise(receiver.pixel);
}
