// Screen-space ambient occlusion, absent: 1 everywhere. A pass with ambient occlusion replaces this module by
// `occluded.wgsl`.
#define_import_path shadowgraph::screen_occlusion

fn screen_occlusion(pixel: vec2f, transparent: bool) -> f32 {
    return 1.0;
}
