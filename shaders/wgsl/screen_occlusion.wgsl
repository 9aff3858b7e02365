// How much of the light from all around the picture's surroundings leave: all of it. A pass that has ambient occlusion of the
// screen puts `occluded.wgsl` in this one's place.
#define_import_path shadowgraph::screen_occlusion

fn screen_occlusion(pixel: vec2f, transparent: bool) -> f32 {
    return 1.0;
}
