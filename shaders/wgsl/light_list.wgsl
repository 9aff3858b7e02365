// The lights to evaluate at a point: all. A pass with light clusters replaces this module by `clustered.wgsl`.
#define_import_path shadowgraph::light_list

// Bit i of word w: light 32 w + i may reach the pixel's surface, `view_depth` metres in front of the camera. Bits beyond the
// number of lights may be set.
fn light_mask(word: u32, pixel: vec2f, view_depth: f32) -> u32 {
    return 0xffffffffu;
}
