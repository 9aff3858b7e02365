//! Measuring: every technique, with all settings, in every view of every light of a scene.

use shadowgraph_shadows::{ShadowSettings, Technique};

use super::report::{CaseReport, Flicker};
use super::{
    Comparator, Compared, MeasuredLight, MeasuredScene, Probe, Reference, Variant, ViewImages,
    measure_flicker, measure_seam,
};
use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::{Gpu, RenderedImage, Renderer, ViewOptions};

use crate::Error;

/// How a scene is measured.
#[derive(Clone, Debug)]
pub struct Task {
    /// The techniques, at least one.
    pub techniques: Vec<Technique>,
    /// Width and height of the pictures, pixels.
    pub size_px: [u32; 2],
    /// The shadow settings. Their maps decide which pixels count, for all variants too.
    pub settings: ShadowSettings,
    /// Further settings, that every technique is measured with.
    pub variants: Vec<Variant>,
    /// How far shadows reach, instead of the settings' own distance.
    pub distance: Option<ShadowDistance>,
    /// How many rays a pixel find soft truth; 0: there is none, and edges are not measured.
    pub soft_rays: u32,
    /// Over how many frames flicker is measured; 0: it is not.
    pub flicker_frames: u32,
    /// Whether flicker is measured in every view of every light, or in one.
    pub flicker_everywhere: bool,
    /// Whether pictures are wanted.
    pub pictures: bool,
}

/// One technique with one variant of settings in one view of one light, as it was measured.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The numbers, without pictures.
    pub report: CaseReport,
    /// The pictures, if they were wanted.
    pub pictures: Option<CaseImages>,
}

/// What was looked at.
#[derive(Clone, Debug)]
pub struct CaseImages {
    /// What the technique draws, in colour.
    pub color: RenderedImage,
    /// What was compared.
    pub compared: ViewImages,
}

/// Measures a scene. `measured` gets what is found as soon as it is, and what it returns ends the work if it is an error.
///
/// # Errors
/// Settings out of range, pictures over the adapter's limits, a scene that cannot be drawn or traced, a failure of the
/// GPU, or what `measured` returns.
pub fn measure<E: From<Error>>(
    gpu: &Gpu,
    measured_scene: &MeasuredScene,
    task: &Task,
    measured: &mut dyn FnMut(Measured) -> Result<(), E>,
) -> Result<(), E> {
    let mut run = Run { gpu, measured_scene, task, benches: Vec::new(), light: None };
    for (light_index, light) in measured_scene.lights.iter().enumerate() {
        run.turn_to(light)?;
        for view in 0..measured_scene.views.len() {
            let flickers = task.flicker_everywhere
                || (light_index, view) == (measured_scene.lights.len().saturating_sub(1) / 2, 0);
            let frames = if flickers { task.flicker_frames } else { 0 };
            for found in run.view(light, view, frames)? {
                measured(found)?;
            }
        }
    }
    Ok(())
}

struct Run<'a> {
    gpu: &'a Gpu,
    measured_scene: &'a MeasuredScene,
    task: &'a Task,
    benches: Vec<Bench>,
    /// The light that the benches show, and its comparator.
    light: Option<(usize, Comparator<'a>)>,
}

/// What draws with one technique.
struct Bench {
    technique: Technique,
    /// The visibility of the light.
    visibility: Renderer,
    color: Option<Renderer>,
    probe: Probe,
}

impl<'a> Run<'a> {
    /// Prepares for a light. Pipelines are made for a light's place in the list, so suns in turn share them.
    fn turn_to(&mut self, light: &MeasuredLight) -> Result<(), Error> {
        if self.light.as_ref().is_none_or(|(index, _)| *index != light.index) {
            let benches = self.task.techniques.iter().map(|&technique| self.bench(technique, light));
            self.benches = benches.collect::<Result<_, _>>()?;
            let Some(first) = self.benches.first() else { return Ok(()) };
            self.light = Some((light.index, Comparator::new(self.gpu, &first.visibility, light.index)?));
        }
        for bench in &mut self.benches {
            bench.visibility.set_lights(light.all.clone())?;
            if let Some(color) = &mut bench.color {
                color.set_lights(light.all.clone())?;
            }
        }
        Ok(())
    }

    fn bench(&self, technique: Technique, light: &MeasuredLight) -> Result<Bench, Error> {
        let mut scene = self.measured_scene.scene.clone();
        scene.lights.clone_from(&light.all);
        let eye = self
            .measured_scene
            .views
            .first()
            .map_or_else(|| scene.framing_camera(1.0), |(_, camera)| camera.clone());
        let renderer = |aov| Renderer::with_config(self.gpu, scene.clone(), &eye, aov, technique);
        let visibility = renderer(Aov::Visibility(light.index as u32))?;
        let color = self.task.pictures.then(|| renderer(Aov::Color)).transpose()?;
        let probe = Probe::new(self.gpu, &visibility)?;
        Ok(Bench { technique, visibility, color, probe })
    }

    fn view(&mut self, light: &MeasuredLight, view: usize, frames: u32) -> Result<Vec<Measured>, Error> {
        let (Some((_, comparator)), Some((name, camera))) =
            (&mut self.light, self.measured_scene.views.get(view))
        else {
            return Ok(Vec::new());
        };
        let Task { size_px, settings, variants, distance, soft_rays, .. } = self.task;
        let options = |settings: &ShadowSettings| {
            let own = ViewOptions { camera: camera.clone(), size_px: *size_px, shadows: settings.clone() };
            match distance {
                Some(distance) => own.with_shadow_distance(*distance, &self.measured_scene.scene),
                None => own,
            }
        };
        let Some(first) = self.benches.first_mut() else { return Ok(Vec::new()) };
        let reference = comparator.reference(&mut first.visibility, &options(settings), *soft_rays)?;
        let mut found = Vec::with_capacity(self.benches.len() * (1 + variants.len()));
        for bench in &mut self.benches {
            let named = variants.iter().map(|variant| (Some(&variant.name), &variant.settings));
            for (variant, settings) in std::iter::once((None, settings)).chain(named) {
                let mut measured = bench.measure(
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
                found.push(measured);
            }
        }
        Ok(found)
    }
}

impl Bench {
    /// Measures a view. The report's names of scene, light and view are left empty.
    fn measure(
        &mut self,
        gpu: &Gpu,
        comparator: &Comparator<'_>,
        reference: &Reference,
        options: &ViewOptions,
        light: usize,
        frames: u32,
    ) -> Result<Measured, Error> {
        let Compared { errors, edges, pictures } =
            comparator.compare(&mut self.visibility, options, reference)?;
        let (seam, cost) = measure_seam(gpu, &self.visibility, &self.probe, options, reference, light)?;
        let report = CaseReport {
            scene: String::new(),
            light: String::new(),
            view: String::new(),
            technique: self.technique.name(),
            errors,
            edges,
            seam,
            flicker: self.flicker(gpu, options, light, frames)?,
            cost: Some(cost),
            pictures: None,
        };
        Ok(Measured { report, pictures: self.pictures(gpu, options, pictures)? })
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

    /// Adds a colour picture to what was compared, if pictures are wanted.
    fn pictures(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        compared: ViewImages,
    ) -> Result<Option<CaseImages>, Error> {
        let Some(renderer) = &mut self.color else { return Ok(None) };
        Ok(Some(CaseImages { color: renderer.draw(gpu, options)?.image, compared }))
    }
}
