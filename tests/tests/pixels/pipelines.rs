//! Pipelines: each renders the same shadows, from files and from scripts, with built-in and custom nodes.

use crate::scenes::{RealScene, real_scenes};
use crate::stage::{gpu, with_coarse_maps};
use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::pipelines::{BUILT_IN, Parameters};
use shadowgraph::scene::Scene;
use shadowgraph::{Gpu, Pipeline, Registry, RenderConfig, RenderedImage, Renderer, ViewOptions};
use shadowgraph_samples::demo::demo_scene;

fn options(scene: &Scene, size_px: [u32; 2]) -> ViewOptions {
    let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(16.0 / 9.0));
    let options = ViewOptions { camera, size_px, shadows: Default::default() };
    with_coarse_maps(options.with_shadow_distance(ShadowDistance::Auto, scene))
}

fn render(gpu: &Gpu, scene: &Scene, aov: Aov, config: RenderConfig, size_px: [u32; 2]) -> RenderedImage {
    let options = options(scene, size_px);
    let mut renderer = Renderer::with_config(gpu, scene.clone(), &options.camera, aov, config).unwrap();
    renderer.draw(gpu, &options).unwrap().image
}

/// Returns the fraction of pixels of which some channel differs by more than 2 of 255.
fn differing(a: &RenderedImage, b: &RenderedImage) -> f64 {
    let pixels = a.rgba8.chunks_exact(4).zip(b.rgba8.chunks_exact(4));
    let differ = pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2)).count();
    differ as f64 / (a.rgba8.len() / 4) as f64
}

#[test]
fn forward_forward_plus_and_deferred_give_real_scenes_the_same_shadows() {
    let Some(gpu) = gpu() else { return };
    for RealScene { name: scene_name, scene, .. } in real_scenes().unwrap_or_default() {
        let visibility =
            |pipeline: Pipeline| render(gpu, scene, Aov::Visibility(0), pipeline.into(), [256, 144]);
        let forward = visibility(Pipeline::minimal_lit());
        for pipeline in [Pipeline::forward_plus(), Pipeline::deferred()] {
            let name = pipeline.name().to_owned();
            let share = differing(&forward, &visibility(pipeline));
            assert!(share <= 0.001, "{scene_name}, {name}: {share}");
        }
    }
}

#[test]
fn every_built_in_pipeline_renders_the_demo_scene_in_the_same_colours() {
    let Some(gpu) = gpu() else { return };
    let scene = demo_scene();
    let draw = |pipeline: Pipeline| render(gpu, &scene, Aov::Color, pipeline.into(), [320, 180]);
    let forward = draw(Pipeline::minimal_lit());
    // All but the one with a sky, and the one that shows cascades.
    for name in BUILT_IN.iter().filter(|name| !["forward", "debug_cascades"].contains(name)) {
        let pipeline: Pipeline = name.parse().unwrap();
        let share = differing(&forward, &draw(pipeline));
        // A G-buffer keeps eight bits of a colour; a screen mask eight of visibility.
        assert!(share < 0.01, "{name}: {share}");
    }
    assert!(forward == draw(Pipeline::forward_plus()), "clusters cull only lights that contribute nothing");
}

#[test]
fn an_unconnected_optional_input_gets_a_placeholder() {
    let Some(gpu) = gpu() else { return };
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("plain.ron");
    let connected = "inputs: {\"image\": \"tonemap\", \"colors\": \"debug\"}";
    let text = Pipeline::built_in_text("debug_cascades").unwrap();
    assert!(text.contains(connected));
    std::fs::write(&file, text.replace(connected, "inputs: {\"image\": \"tonemap\"}")).unwrap();
    let Registry { nodes, techniques } = Registry::built_in();
    let plain = Pipeline::load(&file, &nodes, &techniques, &Parameters::default()).unwrap();
    let scene = demo_scene();
    let draw = |pipeline: Pipeline| render(gpu, &scene, Aov::Color, pipeline.into(), [160, 90]);
    assert!(differing(&draw(plain), &draw(Pipeline::minimal_lit())) == 0.0, "the image is not overwritten");
}
