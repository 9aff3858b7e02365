// A point that may be in shadow: what a technique is asked about.
#define_import_path shadowgraph::receiver

// The surface is blended: what is behind it shows.
const RECEIVER_TRANSPARENT: u32 = 1u;
// The surface was seen from behind and its normals were turned to the viewer.
const RECEIVER_BACK_FACE: u32 = 2u;
// The picture does not show the point at `pixel`: what was worked out for the picture does not hold for it.
const RECEIVER_OFF_SCREEN: u32 = 4u;
// Ask for what the next coarser of the maps that cover the point says, where there is one. For measuring.
const RECEIVER_COARSER: u32 = 8u;

struct Receiver {
    // Metres relative to the frame's origin.
    position: vec3f,
    // Metres in front of the camera.
    view_depth: f32,
    // Of the triangle itself, towards the viewer, unit length.
    geometric_normal: vec3f,
    // RECEIVER_* bits.
    flags: u32,
    // Interpolated and normal mapped, unit length.
    shading_normal: vec3f,
    // Pixel centre in the target: (0.5, 0.5) is the first.
    pixel: vec2f,
    // How the position changes to the next pixel right and down on the surface's plane, metres.
    ddx_position: vec3f,
    ddy_position: vec3f,
}
