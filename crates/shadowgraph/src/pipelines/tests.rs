#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use shadowgraph_samples::demo::demo_scene;
use shadowgraph_shadows::{ShadowSettings, TechniqueContext, Techniques};

use super::{BUILT_IN, Pipeline};
use crate::options::Aov;
use crate::{Gpu, RenderConfig, Renderer, ViewOptions};

#[test]
fn every_built_in_pipeline_has_a_plan_with_every_kind_of_technique() {
    let (gpu, techniques, scene) = (Gpu::noop().unwrap(), Techniques::built_in(), demo_scene());
    for name in BUILT_IN {
        let pipeline: Pipeline = name.parse().unwrap();
        assert!(!pipeline.about().is_empty(), "{name}");
        let color = |name, samples| (name, samples, Aov::Color);
        let mut cases: Vec<_> = ["pcf", "evsm", "sdsm", "pcf+contact"].map(|name| color(name, 1)).to_vec();
        cases.extend([("pcf", 1, Aov::Depth), ("none", 1, Aov::Visibility(0))]);
        if *name != "deferred" {
            cases.push(color("pcf+contact", 4));
        }
        for (technique, samples, aov) in cases {
            let technique = Some(techniques.find(technique).unwrap());
            let config =
                RenderConfig { technique, pipeline: pipeline.clone(), samples, ..RenderConfig::default() };
            let camera = scene.cameras[0].clone();
            let renderer = Renderer::with_config(&gpu, scene.clone(), &camera, aov, config).unwrap();
            let options = ViewOptions { camera, size_px: [64, 36], shadows: ShadowSettings::default() };
            let (plan, _) = renderer.plan(&options).unwrap();
            assert!(!plan.order().is_empty(), "{name}");
        }
    }
}

#[test]
fn every_pipeline_and_technique_runs_with_the_default_limits_and_features_of_webgpu() {
    let adapter = Gpu::noop_adapter().unwrap();
    let opened = adapter.request_device(&wgpu::DeviceDescriptor::default());
    let (device, queue) = pollster::block_on(opened).unwrap();
    let gpu = Gpu { device, queue, adapter: adapter.get_info() };
    let (techniques, scene) = (Techniques::built_in(), demo_scene());
    let kinds = techniques.kinds().iter().map(|kind| (kind.name.to_owned(), "minimal_lit"));
    let modified = ["pcf+contact", "virtual+screen"].map(|name| (name.to_owned(), "forward"));
    let others = BUILT_IN.iter().flat_map(|&name| ["pcf", "virtual"].map(|kind| (kind.to_owned(), name)));
    for (technique, name) in kinds.chain(modified).chain(others) {
        let pipeline = name.parse().unwrap();
        let technique = Some(techniques.find(&technique).unwrap());
        let config = RenderConfig { technique, pipeline, ..RenderConfig::default() };
        let camera = scene.cameras[0].clone();
        let drawn = gpu.checked(|| {
            let mut renderer = Renderer::with_config(&gpu, scene.clone(), &camera, Aov::Color, config)?;
            let options = ViewOptions { camera, size_px: [64, 36], shadows: ShadowSettings::default() };
            renderer.draw(&gpu, &options)
        });
        assert!(drawn.is_ok(), "{technique:?} in {name}: {:?}", drawn.err());
    }
}

#[test]
fn deferred_lighting_with_several_samples_is_refused() {
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let config = RenderConfig { samples: 4, pipeline: Pipeline::deferred(), ..RenderConfig::default() };
    let created = Renderer::with_config(&Gpu::noop().unwrap(), scene, &camera, Aov::Color, config);
    assert!(matches!(created, Err(crate::Error::Lighting(shadowgraph_lighting::Error::Samples { .. }))));
}

#[test]
fn row_36_screen_space_shadows_add_one_shader_variant() {
    let gpu = Gpu::noop().unwrap();
    let pcf = Techniques::built_in().find("pcf").unwrap();
    let variant_count = |technique: shadowgraph_shadows::Technique| {
        technique.make(&TechniqueContext::new(&gpu.device)).unwrap().variant_count()
    };
    assert_eq!(variant_count(pcf.with_screen()), variant_count(pcf) + 1);
}
