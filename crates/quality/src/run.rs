//! Measures every technique, with all settings, in every view of every light of a scene.

use shadowgraph_shadows::{ShadowSettings, Technique};

use super::report::{CaseReport, Flicker};
use super::{
    Comparator, MeasuredLight, MeasuredScene, Probe, Reference, Variant, ViewComparison, ViewImages,
    measure_flicker, measure_seam,
};
use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::{Gpu, RenderedImage, Renderer, ViewOptions};

use crate::Error;

/// Options of a measurement.
#[derive(Clone, Debug)]
pub struct Task {
    /// The techniques, at least one.
    pub techniques: Vec<Technique>,
    /// Width and height of the images, pixels.
    pub size_px: [u32; 2],
    /// The shadow settings. Their maps decide which pixels count, for all variants too.
    pub settings: ShadowSettings,
    /// More settings that every technique is measured with.
    pub variants: Vec<Variant>,
    /// Shadow distance, which overrides that of the settings.
    pub distance: Option<ShadowDistance>,
    /// Rays per pixel of the soft reference; with 0 there is none, and edges are not measured.
    pub soft_rays: u32,
    /// Number of frames over which flicker is measured; with 0 it is not.
    pub flicker_frames: u32,
    /// Whether flicker is measured in every view of every light, or only in one.
    pub flicker_everywhere: bool,
    /// Whether images are returned.
    pub images: bool,
}

/// Result of one technique with one variant of settings in one view of one light.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The numbers, without images.
    pub report: CaseReport,
    /// The images, if requested.
    pub images: Option<CaseImages>,
}

/// The images of a case.
#[derive(Clone, Debug)]
pub struct CaseImages {
    /// The rendered colour image.
    pub color: RenderedImage,
    /// The compared images.
    pub compared: ViewImages,
}

/// Measures a scene. Each result is passed to `on_result` immediately; an error that it returns ends the measurement.
///
/// # Errors
/// Settings out of range, images over the adapter's limits, a scene that cannot be rendered or traced, a failure of the
/// GPU, or the error of `on_result`.
pub fn measure<E: From<Error>>(
    gpu: &Gpu,
    measured_scene: &MeasuredScene,
    task: &Task,
    on_result: &mut dyn FnMut(Measured) -> Result<(), E>,
) -> Result<(), E> {
    let mut run = Run { gpu, measured_scene, task, renderers: Vec::new(), light: None };
    for (light_index, light) in measured_scene.lights.iter().enumerate() {
        run.select_light(light)?;
        for view in 0..measured_scene.views.len() {
            let measures_flicker = task.flicker_everywhere
                || (light_index, view) == (measured_scene.lights.len().saturating_sub(1) / 2, 0);
            let frames = if measures_flicker { task.flicker_frames } else { 0 };
            for result in run.view(light, view, frames)? {
                on_result(result)?;
            }
        }
    }
    Ok(())
}

struct Run<'a> {
    gpu: &'a Gpu,
    measured_scene: &'a MeasuredScene,
    task: &'a Task,
    renderers: Vec<TechniqueRenderers>,
    /// The light that the renderers show, and its comparator.
    light: Option<(usize, Comparator<'a>)>,
}

/// The renderers of one technique.
struct TechniqueRenderers {
    technique: Technique,
    /// Renders the visibility of the light.
    visibility: Renderer,
    color: Option<Renderer>,
    probe: Probe,
}

impl<'a> Run<'a> {
    /// Prepares for a light. Pipelines depend on the index of the light only, so consecutive suns share them.
    fn select_light(&mut self, light: &MeasuredLight) -> Result<(), Error> {
        if self.light.as_ref().is_none_or(|(index, _)| *index != light.index) {
            let renderers =
                self.task.techniques.iter().map(|&technique| self.renderers_for(technique, light));
            self.renderers = renderers.collect::<Result<_, _>>()?;
            let Some(first) = self.renderers.first() else { return Ok(()) };
            self.light = Some((light.index, Comparator::new(self.gpu, &first.visibility, light.index)?));
        }
        for renderer_set in &mut self.renderers {
            renderer_set.visibility.scene_mut().set_lights(light.all.clone());
            if let Some(color) = &mut renderer_set.color {
                color.scene_mut().set_lights(light.all.clone());
            }
        }
        Ok(())
    }

    fn renderers_for(
        &self,
        technique: Technique,
        light: &MeasuredLight,
    ) -> Result<TechniqueRenderers, Error> {
        let mut scene = self.measured_scene.scene.clone();
        scene.set_lights(light.all.clone());
        let eye = self
            .measured_scene
            .views
            .first()
            .map_or_else(|| scene.framing_camera(1.0), |(_, camera)| camera.clone());
        let renderer = |aov| Renderer::with_config(self.gpu, scene.clone(), &eye, aov, technique);
        let visibility = renderer(Aov::Visibility(light.index as u32))?;
        let color = self.task.images.then(|| renderer(Aov::Color)).transpose()?;
        let probe = Probe::new(self.gpu, &visibility)?;
        Ok(TechniqueRenderers { technique, visibility, color, probe })
    }

    fn view(&mut self, light: &MeasuredLight, view: usize, frames: u32) -> Result<Vec<Measured>, Error> {
        let (Some((_, comparator)), Some((name, camera))) =
            (&mut self.light, self.measured_scene.views.get(view))
        else {
            return Ok(Vec::new());
        };
        let Task { size_px, settings, variants, distance, soft_rays, .. } = self.task;
        let options = |settings: &ShadowSettings| {
            let options =
                ViewOptions { camera: camera.clone(), size_px: *size_px, shadows: settings.clone() };
            match distance {
                Some(distance) => options.with_shadow_distance(*distance, &self.measured_scene.scene),
                None => options,
            }
        };
        let Some(first) = self.renderers.first_mut() else { return Ok(Vec::new()) };
        let reference = comparator.reference(&mut first.visibility, &options(settings), *soft_rays)?;
        let mut results = Vec::with_capacity(self.renderers.len() * (1 + variants.len()));
        for renderer_set in &mut self.renderers {
            let named = variants.iter().map(|variant| (Some(&variant.name), &variant.settings));
            for (variant, settings) in std::iter::once((None, settings)).chain(named) {
                let mut measured = renderer_set.measure(
                    self.gpu,
                    comparator,
                    &reference,
                    &options(settings),
                    light.index,
                    frames,
                )?;
                measured.report.scene.clone_from(&self.measured_scene.name);
                measured.report.light.clone_from(&light.name);
                measured.report.view.clone_from(name);
                if let Some(variant) = variant {
                    measured.report.technique.push_str(": ");
                    measured.report.technique.push_str(variant);
                }
                results.push(measured);
            }
        }
        Ok(results)
    }
}

impl TechniqueRenderers {
    /// Measures a view as it settles after a cut of the camera. The names of scene, light and view in the report are left empty.
    fn measure(
        &mut self,
        gpu: &Gpu,
        comparator: &Comparator<'_>,
        reference: &Reference,
        options: &ViewOptions,
        light: usize,
        frames: u32,
    ) -> Result<Measured, Error> {
        self.visibility.draw(gpu, options)?;
        let ViewComparison { errors, edges, images } =
            comparator.compare(&mut self.visibility, options, reference)?;
        let (seam, cost) = measure_seam(gpu, &self.visibility, &self.probe, options, reference, light)?;
        let images = self.images(gpu, options, images)?;
        // Last, as its camera moves.
        let flicker = self.flicker(gpu, options, light, frames)?;
        let report = CaseReport {
            scene: String::new(),
            light: String::new(),
            view: String::new(),
            technique: self.technique.name(),
            errors,
            edges,
            seam,
            flicker,
            cost: Some(cost),
            images: None,
        };
        Ok(Measured { report, images })
    }

    fn flicker(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        light: usize,
        frames: u32,
    ) -> Result<Vec<Flicker>, Error> {
        match frames {
            0 => Ok(Vec::new()),
            frames => measure_flicker(gpu, &mut self.visibility, self.technique, options, light, frames),
        }
    }

    /// Adds a colour image to the compared images, if images are requested.
    fn images(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        compared: ViewImages,
    ) -> Result<Option<CaseImages>, Error> {
        let Some(renderer) = &mut self.color else { return Ok(None) };
        Ok(Some(CaseImages { color: renderer.draw(gpu, options)?.image, compared }))
    }
}
