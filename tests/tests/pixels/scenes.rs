//! Real scenes: each renders.

use crate::stage::gpu;
use shadowgraph::options::{Aov, ShadowDistance, SunChoice};
use shadowgraph::{Renderer, ViewOptions};
use std::collections::HashSet;

#[test]
fn every_shared_scene_renders() {
    let Some(gpu) = gpu() else { return };
    let Some(dir) = shadowgraph_tests::shared("scenes") else {
        return shadowgraph_tests::skip(
            "scenes",
            "the collection of real scenes is missing (SHADOWGRAPH_SHARED)",
        );
    };
    let mut files: Vec<_> = std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "glb"));
    files.sort();
    assert_eq!(files.len(), 21);
    for file in files {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let mut scene = shadowgraph::scene::gltf::load(&file).unwrap();
        SunChoice::default().apply(&mut scene);
        let size_px = [160, 90];
        let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(16.0 / 9.0));
        let options = ViewOptions { camera, size_px, shadows: Default::default() }
            .with_shadow_distance(ShadowDistance::Auto, &scene);
        let mut renderer = Renderer::new(gpu, scene, &options.camera, Aov::Color).unwrap();
        let picture = renderer.draw(gpu, &options).unwrap().image;
        let colors: HashSet<_> = picture.rgba8.chunks_exact(4).collect();
        assert!(colors.len() > 16, "{name} is more than a background: {} colours", colors.len());
    }
}
