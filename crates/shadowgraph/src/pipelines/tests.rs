#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use std::sync::Arc;

use shadowgraph_core::Plan;
use shadowgraph_scene::demo::demo_scene;
use shadowgraph_shadows::{ShadowSettings, Techniques};

use super::{BUILT_IN, Pipeline};
use crate::options::Aov;
use crate::{Gpu, Method, Renderer, ViewOptions};

fn plan(gpu: &Gpu, aov: Aov, method: Method) -> Arc<Plan> {
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let renderer = Renderer::with(gpu, scene, &camera, aov, method).unwrap();
    let options = ViewOptions { camera, size_px: [64, 36], shadows: ShadowSettings::default() };
    renderer.plan(&options).unwrap().0
}

#[test]
fn every_built_in_file_gives_the_plan_of_its_twin_in_rust() {
    let (gpu, techniques) = (Gpu::noop().unwrap(), Techniques::built_in());
    let scripts = Pipeline::scripts();
    assert_eq!(scripts.iter().map(Pipeline::name).collect::<Vec<_>>(), BUILT_IN);
    for script in scripts {
        let file: Pipeline = script.name().parse().unwrap();
        assert!(file != script && !file.about().is_empty());
        let color = |name, samples| (name, samples, Aov::Color);
        let mut cases: Vec<_> = ["pcf", "evsm", "sdsm", "pcf+contact"].map(|name| color(name, 1)).to_vec();
        cases.extend([("pcf", 1, Aov::Depth), ("none", 1, Aov::Visibility(0))]);
        if script.name() != "deferred" {
            cases.push(color("pcf+contact", 4));
        }
        for (name, samples, aov) in cases {
            let technique = Some(techniques.find(name).unwrap());
            let of = |pipeline: &Pipeline| {
                plan(&gpu, aov.clone(), Method { technique, pipeline: pipeline.clone(), samples })
            };
            let (of_file, of_script) = (of(&file), of(&script));
            let diff = of_file.diff(&of_script).unwrap().to_text();
            assert!(of_file == of_script, "{}, {name}, {samples} samples\n{diff}", script.name());
        }
    }
}

#[test]
fn deferred_lighting_of_several_samples_is_refused_with_the_option() {
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let method = Method { samples: 4, pipeline: Pipeline::deferred(), ..Method::default() };
    let error = Renderer::with(&Gpu::noop().unwrap(), scene, &camera, Aov::Color, method).err().unwrap();
    assert_eq!(error.to_string(), "deferred lighting supports 1 sample per pixel, not 4");
}
