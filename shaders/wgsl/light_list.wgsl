// The lights to evaluate at a point: all. A pass with light clusters replaces this module by `clustered.wgsl`.
#define_import_path shadowgraph::light_list

// The first light, from `begin` on, that may reach the pixel's surface, `view_depth` metres in front of the camera; the number of
// lights or more if there is none.
fn next_light(begin: u32, pixel: vec2f, view_depth: f32) -> u32 {
    return begin;
}
