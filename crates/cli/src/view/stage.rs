//! What is shown: a scene, drawn by a renderer that is made anew when the method changes.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::fly::Fly;
use super::reload::Watched;
use crate::args::{DrawArgs, ViewArgs};
use crate::commands::{Input, load};
use crate::failure::Failure;
use shadowgraph::core::{Format, Plan, TimeHistory, Timer};
use shadowgraph::options::{Aov, SettingsFile, ShadowDistance, SunChoice};
use shadowgraph::scene::Scene;
use shadowgraph::shadows::{ShadowSettings, Technique};
use shadowgraph::{Gpu, Pipeline, Registry, RenderConfig, Renderer, ViewOptions, wgpu};

/// Frames that times are kept of.
const FRAMES: usize = 60;

/// What the user has chosen, and what follows from it.
pub(super) struct Stage {
    pub(super) scene: Scene,
    pub(super) registry: Registry,
    draw: DrawArgs,
    pub(super) technique: Technique,
    pub(super) pipeline: Pipeline,
    samples: u32,
    pub(super) aov: Aov,
    pub(super) settings: ShadowSettings,
    pub(super) fly: Fly,
    /// Whether shadows stay those of the place where the camera was.
    pub(super) frozen: bool,
    pub(super) times: TimeHistory,
    /// The plan of the last good frame.
    pub(super) plan: Option<Arc<Plan>>,
    /// Why the last frame is not the newest.
    pub(super) error: Option<String>,
    /// Why a file was not taken, until one is.
    pub(super) refused: Option<String>,
    /// What was done last.
    pub(super) note: String,
    pub(super) settings_file: Option<PathBuf>,
    watched_settings: Watched,
    watched_pipeline: Watched,
    watched_shaders: Watched,
    renderer: Option<Renderer>,
    /// What was asked for last, and why there is no renderer for it: it is not tried again for the same.
    made: Option<(Asked, Result<(), String>)>,
}

/// What a renderer is made for.
type Asked = (Technique, Pipeline, Aov);

impl Stage {
    pub(super) fn new(
        input: Input,
        view: ViewOptions,
        registry: Registry,
        args: &ViewArgs,
    ) -> Result<Self, Failure> {
        let reach_m = input.scene.bounds().radius();
        let shaders = args.shaders.iter().flat_map(|folder| {
            shadowgraph::shaders::builtin_files().map(|file| folder.join(file)).collect::<Vec<_>>()
        });
        let settings_file = args.draw.settings_file().map(PathBuf::from);
        Ok(Self {
            fly: Fly::new(input.camera, reach_m),
            scene: input.scene,
            technique: input.options.render_config().technique(),
            registry,
            draw: args.draw.clone(),
            pipeline: input.options.pipeline,
            samples: input.options.samples,
            aov: input.options.aov,
            settings: view.shadows,
            frozen: false,
            times: TimeHistory::new(FRAMES),
            plan: None,
            error: None,
            refused: None,
            note: String::new(),
            watched_settings: Watched::new(settings_file.clone()),
            settings_file,
            watched_pipeline: Watched::new(args.draw.pipeline_file().map(PathBuf::from)),
            watched_shaders: Watched::new(shaders),
            renderer: None,
            made: None,
        })
    }

    /// Shows another scene, from its first camera; the built-in one without a file. One that cannot be read changes nothing.
    pub(super) fn open(&mut self, file: Option<&Path>) {
        let mut scene = match load(file) {
            Ok(scene) => scene,
            Err(failure) => return self.refused = Some(failure.message),
        };
        let name = file.map_or("the built-in scene".into(), |file| file.display().to_string());
        self.note = SunChoice::default().apply(&mut scene).unwrap_or(name);
        let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(16.0 / 9.0));
        let view = ViewOptions { camera: camera.clone(), size_px: [16, 9], shadows: self.settings.clone() };
        self.settings = view.with_shadow_distance(ShadowDistance::Auto, &scene).shadows;
        self.fly = Fly::new(camera, scene.bounds().radius());
        (self.scene, self.aov, self.frozen) = (scene, Aov::default(), false);
        (self.renderer, self.made, self.refused) = (None, None, None);
    }

    /// Reads again what was saved since the last frame.
    pub(super) fn reload(&mut self) {
        if self.watched_shaders.changed() {
            self.made = None;
            self.note = "shaders were read again".into();
        }
        if self.watched_pipeline.changed() {
            match self.draw.pipeline(&self.registry) {
                Ok(pipeline) => {
                    (self.pipeline, self.refused) = (pipeline, None);
                    self.note = format!("{} was read again", self.pipeline.name());
                    for warning in self.pipeline.warnings() {
                        self.note += &format!("; {warning}");
                    }
                }
                Err(error) => self.refused = Some(error.to_string()),
            }
        }
        if self.watched_settings.changed()
            && let Some(file) = &self.settings_file
        {
            match SettingsFile::load(file, &self.registry.techniques) {
                Ok(read) => {
                    (self.settings, self.refused) = (read.settings, None);
                    self.note = format!("{} was read again", file.display());
                }
                Err(error) => self.refused = Some(error.to_string()),
            }
        }
    }

    /// Holds shadows where the camera is, or lets them follow it again.
    pub(super) fn freeze(&mut self, frozen: bool) {
        self.frozen = frozen;
        let camera = frozen.then(|| self.fly.camera().clone());
        if let Some(renderer) = &mut self.renderer {
            renderer.set_shadow_camera(camera);
        }
    }

    /// How the view is drawn now.
    pub(super) fn options(&self, size_px: [u32; 2]) -> ViewOptions {
        ViewOptions { camera: self.fly.camera().clone(), size_px, shadows: self.settings.clone() }
    }

    /// The format of the texture that is drawn into.
    pub(super) fn format(&self) -> Format {
        let depth = |name: &String| {
            let plan = self.plan.as_ref()?;
            match plan.resource(plan.find_resource(name)?).desc {
                shadowgraph::core::ResourceDesc::Texture(desc) => Some(desc.format.is_depth_stencil_format()),
                shadowgraph::core::ResourceDesc::Buffer(_) => None,
            }
        };
        match &self.aov {
            Aov::Color => Format::Rgba8UnormSrgb,
            Aov::Texture(name) if depth(name) != Some(true) => Format::Rgba8UnormSrgb,
            _ => Format::Rgba8Unorm,
        }
    }

    /// Draws a frame into `target`. What goes wrong is kept as [`error`](Self::error), and the target stays as it was.
    pub(super) fn draw(&mut self, gpu: &Gpu, target: &wgpu::Texture) {
        match self.try_draw(gpu, target) {
            Ok(()) => self.error = None,
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    fn try_draw(&mut self, gpu: &Gpu, target: &wgpu::Texture) -> Result<(), shadowgraph::Error> {
        self.make(gpu)?;
        let options = self.options([target.width(), target.height()]);
        self.registry.techniques.check(&options.shadows)?;
        let Some(renderer) = &mut self.renderer else { return Ok(()) };
        let mut timer = Timer::new();
        let plan = gpu.checked(|| -> Result<_, shadowgraph::Error> {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let executed = renderer.record_timed(gpu, &mut encoder, target, &options, Some(&mut timer))?;
            gpu.queue.submit([encoder.finish()]);
            Ok(executed.shared_plan())
        })?;
        self.times.add(&timer.read(&gpu.device, &gpu.queue)?);
        self.plan = Some(plan);
        Ok(())
    }

    /// Makes the renderer for what is chosen. Where that fails the old one stays, and its picture.
    fn make(&mut self, gpu: &Gpu) -> Result<(), shadowgraph::Error> {
        let wanted = (self.technique, self.pipeline.clone(), self.aov.clone());
        if let Some((_, made)) = self.made.as_ref().filter(|(asked, _)| *asked == wanted) {
            return made.clone().map_err(shadowgraph::Error::Gpu);
        }
        let (technique, pipeline) = (Some(self.technique), self.pipeline.clone());
        let config = RenderConfig { technique, pipeline, samples: self.samples };
        let made = gpu.checked(|| {
            Renderer::with_config(gpu, self.scene.clone(), self.fly.camera(), self.aov.clone(), config)
        });
        let failed = made.as_ref().err().map(ToString::to_string);
        self.made = Some((wanted, failed.map_or(Ok(()), Err)));
        let renderer = made?;
        let frozen = self.renderer.as_ref().and_then(|old| old.shadow_camera().cloned());
        self.renderer.insert(renderer).set_shadow_camera(frozen);
        Ok(())
    }

    /// Returns the page about the frame as it is now.
    pub(super) fn page(&mut self, gpu: &Gpu, size_px: [u32; 2]) -> Result<String, shadowgraph::Error> {
        let options = self.options(size_px);
        let lights = self.scene.lights.clone();
        let Some(renderer) = &mut self.renderer else { return Ok(String::new()) };
        Ok(renderer.inspect(gpu, &options)?.page(&lights, &options).to_html())
    }
}
