// Which lights a point asks: all of them. A pass that has clusters of lights puts `clustered.wgsl` in this one's place.
#define_import_path shadowgraph::light_list

// Bit i of word w: light 32 w + i may reach the pixel's surface, `view_depth` metres in front of the camera. Bits of lights that
// there are not may be set.
fn light_mask(word: u32, pixel: vec2f, view_depth: f32) -> u32 {
    return 0xffffffffu;
}
