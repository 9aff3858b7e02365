//! `shadowgraph measure --noise`: the noise that temporal anti-aliasing leaves.

use super::args::{MeasureArgs, settings_file};
use super::console;
use super::failure::Failure;
use super::measure::work;
use super::progress::Progress;
use shadowgraph::options::{AdapterChoice, Aov, ShadowDistance, Size};
use shadowgraph::{Gpu, Registry, Renderer, ViewOptions};
use shadowgraph_quality::{
    MeasuredScene, NoiseErrors, NoiseTask, Noisy, TextTable, measure_noise, noisy_techniques,
};

/// The angular radius of the sun, radians: penumbrae are wider than pixels.
const SUN_RADIUS_RAD: f32 = 0.02;

/// Measures one light in one view of each scene, and prints the table.
pub(crate) fn noise_command(args: &MeasureArgs, registry: &Registry) -> Result<(), Failure> {
    let size: Size = args.size.as_deref().unwrap_or("192x108").parse()?;
    let distance: Option<ShadowDistance> = args.shadow_distance.as_deref().map(str::parse).transpose()?;
    let adapter = args.adapter.as_deref().map_or(Ok(AdapterChoice::default()), str::parse)?;
    let settings = settings_file(args.settings.as_deref(), &registry.techniques)?.settings;
    let noisy = noisy_techniques(&settings, SUN_RADIUS_RAD)?;
    let scenes = work(args, size)?;
    let gpu = Gpu::open(&adapter).map_err(Failure::no_device)?;
    let progress = Progress::if_slow("measuring");
    let mut errors = vec![NoiseErrors::default(); noisy.len()];
    scenes.each(true, &mut |part, measured_scene| {
        for (of, errors) in noisy.iter().zip(&mut errors) {
            progress.set(&format!("{}, {}", measured_scene.name, of.name), part);
            measure_scene(&gpu, measured_scene, of, ([size.width_px, size.height_px], distance), errors)?;
        }
        Ok(())
    })?;
    drop(progress);
    console::print(&table(&noisy, &errors))
}

fn measure_scene(
    gpu: &Gpu,
    measured_scene: &MeasuredScene,
    noisy: &Noisy,
    (size_px, distance): ([u32; 2], Option<ShadowDistance>),
    errors: &mut NoiseErrors,
) -> Result<(), Failure> {
    for light in &measured_scene.lights {
        for (_, camera) in &measured_scene.views {
            let mut scene = measured_scene.scene.clone();
            scene.set_lights(light.all.clone());
            let options = ViewOptions { camera: camera.clone(), size_px, shadows: noisy.settings.clone() };
            let options = match distance {
                Some(distance) => options.with_shadow_distance(distance, &scene),
                None => options,
            };
            let aov = Aov::Visibility(light.index as u32);
            let mut renderer = Renderer::with_config(gpu, scene, camera, aov, noisy.technique)?;
            let light = (light.index, SUN_RADIUS_RAD);
            errors.add(&measure_noise(gpu, &mut renderer, &options, light, NoiseTask::default())?);
        }
    }
    Ok(())
}

fn table(noisy: &[Noisy], errors: &[NoiseErrors]) -> String {
    let NoiseTask { frames, mean_frames, soft_rays, .. } = NoiseTask::default();
    let averaged = format!("{frames} frames");
    let header =
        ["technique", "one frame", &averaged, "ratio", "soft, fixed noise", "soft"].map(str::to_owned);
    let row = |(noisy, errors): (&Noisy, &NoiseErrors)| {
        let [one, averaged] = [errors.one_frame, errors.averaged].map(|error| error.value());
        let [fixed, soft] = [errors.fixed_to_soft, errors.averaged_to_soft].map(|error| error.value());
        let number = |value: f64| format!("{value:.4}");
        [
            noisy.name.to_owned(),
            number(one),
            number(averaged),
            format!("{:.2}", averaged / one.max(1e-9)),
            number(fixed),
            number(soft),
        ]
    };
    let rows = std::iter::once(header).chain(noisy.iter().zip(errors).map(row));
    let table = TextTable { alignment: "lrrrrr", indent: 0, width: usize::MAX }.format(rows);
    format!(
        "{table}\nRoot mean square errors of visibility at receivers: one frame, and {frames} frames of temporal \
         anti-aliasing, against the mean of {mean_frames} frames; and those {frames} frames against {soft_rays} rays \
         per pixel, with noise that is the same in every frame and with noise that changes.\n"
    )
}
