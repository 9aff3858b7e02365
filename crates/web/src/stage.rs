//! What is shown, and how: a scene, one or two techniques, a pipeline, and shadow settings.

use std::sync::Arc;

use shadowgraph::core::{Plan, Timer};
use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::pipelines::Parameters;
use shadowgraph::scene::{AnimationSelection, Camera};
use shadowgraph::shadows::{ShadowSettings, Technique};
use shadowgraph::{Gpu, PendingCounts, Pipeline, Registry, RenderConfig, Renderer, ViewOptions, wgpu};

use crate::error::Error;
use crate::model::Model;
use crate::orbit::Orbit;
use crate::settings::settings_from_json;

/// A model with everything that chooses its image. A change creates a renderer again only if it must.
pub struct Stage {
    registry: Registry,
    model: Model,
    /// The camera.
    pub orbit: Orbit,
    pipeline: Pipeline,
    settings: ShadowSettings,
    distance: ShadowDistance,
    time_s: f64,
    first: View,
    /// The view of the technique that is compared with the first one.
    second: Option<View>,
}

/// The view of one technique, with its renderer once it was drawn.
struct View {
    technique: Technique,
    renderer: Option<Renderer>,
    /// The pipeline that the renderer was requested for, and why there is none.
    requested: Option<(Pipeline, Result<(), String>)>,
    /// The shadow distance of the last frame, which the next one follows.
    distance_m: f32,
}

/// A frame that was recorded.
pub struct Recorded {
    /// The plan.
    pub plan: Arc<Plan>,
    /// What the GPU counts, if it was measured.
    pub counts: Option<PendingCounts>,
}

impl Stage {
    /// Shows a model with the default technique, pipeline and settings, from its [camera](Model::camera) for images of an aspect ratio.
    #[must_use]
    pub fn new(model: Model, aspect: f64) -> Self {
        let orbit = Orbit::new(model.camera(aspect), &model.scene.bounds());
        Self {
            registry: Registry::built_in(),
            orbit,
            model,
            pipeline: Pipeline::default(),
            settings: ShadowSettings::default(),
            distance: ShadowDistance::Auto,
            time_s: 0.0,
            first: View::new(Technique::default()),
            second: None,
        }
    }

    /// Returns the techniques and nodes.
    #[must_use]
    pub fn registry(&self) -> &Registry {
        &self.registry
    }

    /// Returns the model.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Shows another model, from its [camera](Model::camera) for images of an aspect ratio, and at time 0.
    pub fn show(&mut self, model: Model, aspect: f64) {
        self.orbit = Orbit::new(model.camera(aspect), &model.scene.bounds());
        (self.model, self.time_s) = (model, 0.0);
        self.forget_renderers();
    }

    /// Forgets everything on the device, for another one.
    pub fn forget_renderers(&mut self) {
        for view in [Some(&mut self.first), self.second.as_mut()].into_iter().flatten() {
            (view.renderer, view.requested) = (None, None);
        }
    }

    /// Chooses the technique by name, such as `pcss+contact`.
    ///
    /// # Errors
    /// For an unknown name: the known ones.
    pub fn set_technique(&mut self, name: &str) -> Result<(), Error> {
        self.first.set_technique(self.registry.techniques.find(name)?);
        Ok(())
    }

    /// Returns the name of the technique.
    #[must_use]
    pub fn technique(&self) -> String {
        self.first.technique.name()
    }

    /// Chooses a second technique, whose image is compared with the first one's; `None` ends the comparison.
    ///
    /// # Errors
    /// As [`set_technique`](Self::set_technique).
    pub fn compare_with(&mut self, name: Option<&str>) -> Result<(), Error> {
        let Some(name) = name else {
            self.second = None;
            return Ok(());
        };
        let technique = self.registry.techniques.find(name)?;
        self.second.get_or_insert_with(|| View::new(technique)).set_technique(technique);
        Ok(())
    }

    /// Returns the name of the second technique.
    #[must_use]
    pub fn compared(&self) -> Option<String> {
        self.second.as_ref().map(|view| view.technique.name())
    }

    /// Chooses a built-in pipeline by its name.
    ///
    /// # Errors
    /// For an unknown name.
    pub fn set_pipeline(&mut self, name: &str) -> Result<(), Error> {
        self.pipeline = Pipeline::built_in(name, &Parameters::default())?;
        Ok(())
    }

    /// Chooses a pipeline by the text of its file, which errors call `name`. Returns the warnings about it.
    ///
    /// # Errors
    /// For an invalid file: line and column, and what is expected.
    pub fn set_pipeline_text(&mut self, name: &str, text: &str) -> Result<Vec<String>, Error> {
        let Registry { nodes, techniques } = &self.registry;
        let pipeline = Pipeline::from_text(name, text, nodes, techniques, &Parameters::default())?;
        self.pipeline = pipeline;
        Ok(self.pipeline.warnings().iter().map(ToString::to_string).collect())
    }

    /// Returns the pipeline.
    #[must_use]
    pub fn pipeline(&self) -> &Pipeline {
        &self.pipeline
    }

    /// Chooses the shadow settings, as JSON. Without `distance_m` the shadow distance is as far as the visible part of the scene reaches.
    ///
    /// # Errors
    /// As [`settings_from_json`]; the settings stay as they were.
    pub fn set_settings(&mut self, json: &str) -> Result<(), Error> {
        let (settings, has_distance) = settings_from_json(json, &self.registry.techniques)?;
        self.distance = match has_distance {
            true => ShadowDistance::Metres(f64::from(settings.distance_m)),
            false => ShadowDistance::Auto,
        };
        self.settings = settings;
        Ok(())
    }

    /// Returns how long the animations of the model are, seconds; 0 without any.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        f64::from(self.model.scene.hierarchy.end_s(AnimationSelection::All))
    }

    /// Moves the model to a moment of its animations, which repeat.
    ///
    /// # Errors
    /// For animations that the scene refuses.
    pub fn set_time(&mut self, time_s: f64) -> Result<(), Error> {
        let duration_s = self.duration_s();
        let time_s = if duration_s > 0.0 { time_s.rem_euclid(duration_s) } else { 0.0 };
        if time_s == self.time_s || !time_s.is_finite() {
            return Ok(());
        }
        self.time_s = time_s;
        self.model.scene.set_time(AnimationSelection::All, time_s)?;
        let renderers = [Some(&mut self.first), self.second.as_mut()].into_iter().flatten();
        for renderer in renderers.filter_map(|view| view.renderer.as_mut()) {
            renderer.scene_mut().set_time(AnimationSelection::All, time_s)?;
        }
        Ok(())
    }

    /// Returns how many images are compared: 1 or 2.
    #[must_use]
    pub fn image_count(&self) -> usize {
        1 + usize::from(self.second.is_some())
    }

    /// Records the image of the technique with this index, 0 or 1, into `target`, of format `Rgba8UnormSrgb`.
    ///
    /// # Errors
    /// Those of the renderer. For a technique and a pipeline that do not fit, the last ones that did stay.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        index: usize,
        target: &wgpu::Texture,
        timer: Option<&mut Timer>,
    ) -> Result<Recorded, Error> {
        let Self { model, orbit, pipeline, settings, distance, first, second, .. } = self;
        let view = second.as_mut().filter(|_| index > 0).unwrap_or(first);
        let size_px = [target.width(), target.height()];
        let shadows = ShadowSettings { distance_m: view.distance_m, ..settings.clone() };
        let options = ViewOptions { camera: orbit.camera().clone(), size_px, shadows };
        let options = options.with_shadow_distance(*distance, &model.scene);
        view.distance_m = options.shadows.distance_m;
        let renderer = view.renderer(gpu, model, &options.camera, pipeline)?;
        let (executed, counts) = match timer {
            Some(timer) => {
                let (executed, counts) = renderer.record_measured(gpu, encoder, target, &options, timer)?;
                (executed, Some(counts))
            }
            None => (renderer.record(gpu, encoder, target, &options)?, None),
        };
        Ok(Recorded { plan: executed.shared_plan(), counts })
    }
}

impl View {
    fn new(technique: Technique) -> Self {
        Self { technique, renderer: None, requested: None, distance_m: ShadowSettings::default().distance_m }
    }

    fn set_technique(&mut self, technique: Technique) {
        if technique != self.technique {
            (self.technique, self.requested) = (technique, None);
        }
    }

    /// Returns the renderer, which is created if there is none for these choices. A failure is returned again until a choice changes.
    fn renderer(
        &mut self,
        gpu: &Gpu,
        model: &Model,
        camera: &Camera,
        pipeline: &Pipeline,
    ) -> Result<&mut Renderer, Error> {
        if self.requested.as_ref().is_none_or(|(last, _)| last != pipeline) {
            let config = RenderConfig {
                technique: Some(self.technique),
                pipeline: pipeline.clone(),
                ..RenderConfig::default()
            };
            let created = Renderer::with_config(gpu, model.scene.clone(), camera, Aov::Color, config);
            let failed = created.as_ref().err().map(ToString::to_string);
            self.requested = Some((pipeline.clone(), failed.map_or(Ok(()), Err)));
            self.renderer = Some(created?);
        }
        match (&self.requested, &mut self.renderer) {
            (Some((_, Ok(()))), Some(renderer)) => Ok(renderer),
            (Some((_, Err(reason))), _) => Err(shadowgraph::Error::Gpu(reason.clone()).into()),
            _ => Err(shadowgraph::Error::Gpu("there is no renderer".into()).into()),
        }
    }
}
