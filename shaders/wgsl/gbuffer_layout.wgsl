// The layout of the G-buffer: 32 bytes a pixel.
#define_import_path shadowgraph::gbuffer_layout

const SURFACE_UNLIT: u32 = 1u;
const SURFACE_UNSHADOWED: u32 = 2u;
const SURFACE_BACK_FACE: u32 = 4u;

// Eight flags in a channel that stores 0 to 1.
fn flags_to_unorm(flags: u32) -> f32 {
    return f32(flags) / 255.0;
}

fn flags_from_unorm(channel: f32) -> u32 {
    return u32(round(channel * 255.0));
}
