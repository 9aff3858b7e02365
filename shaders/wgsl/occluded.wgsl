// How much of the light from all around reaches what the picture shows.
#define_import_path shadowgraph::screen_occlusion

@group(0) @binding(OCCLUSION) var occlusion_of_screen: texture_2d<f32>;

fn screen_occlusion(pixel: vec2f, transparent: bool) -> f32 {
    // It is that of what is behind what is blended.
    if transparent {
        return 1.0;
    }
    return textureLoad(occlusion_of_screen, vec2u(pixel), 0).r;
}
