// Screen-space ambient occlusion, read from a texture; 1 is not occluded.
#define_import_path shadowgraph::screen_occlusion

@group(0) @binding(OCCLUSION) var occlusion_texture: texture_2d<f32>;

fn screen_occlusion(pixel: vec2f, transparent: bool) -> f32 {
    // The texture has the occlusion of the surface behind blended geometry.
    if transparent {
        return 1.0;
    }
    return textureLoad(occlusion_texture, vec2u(pixel), 0).r;
}
