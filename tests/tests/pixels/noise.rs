//! Noise that changes from frame to frame where frames are averaged.

use crate::stage::gpu;
use shadowgraph::options::Aov;
use shadowgraph::shadows::ShadowSettings;
use shadowgraph::{Renderer, ViewOptions};
use shadowgraph_quality::{CaseSet, MeasuredScene, NoiseTask, measure_noise, noisy_techniques};
use std::path::Path;

/// Angular radius of the sun: penumbrae are wider than pixels.
const SUN_RADIUS_RAD: f32 = 0.06;

#[test]
fn averaging_removes_noise_and_brings_no_error() {
    let Some(gpu) = gpu() else { return };
    let (name, text) = (Path::new("noise.ron"), include_str!("../../../docs/noise.ron"));
    let cases = CaseSet::parse(text, name).unwrap().cases;
    let MeasuredScene { mut scene, lights, views, .. } =
        MeasuredScene::from_case(&cases[1], Path::new("")).unwrap();
    scene.set_lights(lights[0].all.clone());
    let camera = &views[0].1;
    let task = NoiseTask { frames: 16, mean_frames: 48, soft_rays: 24, jitters: false };
    for noisy in noisy_techniques(&ShadowSettings::default(), SUN_RADIUS_RAD).unwrap() {
        let options =
            ViewOptions { camera: camera.clone(), size_px: [160, 90], shadows: noisy.settings.clone() };
        let aov = Aov::Visibility(0);
        let mut renderer = Renderer::with_config(gpu, scene.clone(), camera, aov, noisy.technique).unwrap();
        let errors = measure_noise(gpu, &mut renderer, &options, (0, SUN_RADIUS_RAD), task).unwrap();
        let [one, averaged] = [errors.one_frame, errors.averaged].map(|error| error.value());
        let [fixed, soft] = [errors.fixed_to_soft, errors.averaged_to_soft].map(|error| error.value());
        println!("{}: one frame {one:.4}, averaged {averaged:.4}, to soft {fixed:.4}, {soft:.4}", noisy.name);
        // Half floats do not resolve less.
        assert!(one > 0.0 && averaged < (one / 3.0).max(0.0005), "{}: {averaged} of {one}", noisy.name);
        assert!(soft < fixed + 0.0005, "{}: {soft} instead of {fixed}", noisy.name);
    }
}
