//! The displayed scene, with a renderer that is created again when technique, pipeline or output change.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::fly::FlyCamera;
use super::live::{Adjustable, Live};
use super::playback::Playback;
use super::reload::Watched;
use super::sun::Sun;
use crate::args::{DrawArgs, ViewArgs};
use crate::commands::{Input, load, shadow_camera};
use crate::failure::Failure;
use crate::pixel;
use crate::recording;
use shadowgraph::core::{Format, Plan, TimeHistory, Timer};
use shadowgraph::options::{Aov, GroundChoice, OptionError, SettingsFile, ShadowDistance, SunChoice};
use shadowgraph::recording::Recorder;
use shadowgraph::scene::{AnimationSelection, Camera, Scene};
use shadowgraph::shadows::{BudgetConfig, QualityController, SettingTracks, ShadowSettings, Technique};
use shadowgraph::{
    Background, Culling, FrameCounts, Gpu, Pipeline, Registry, RenderConfig, Renderer, ShadowLines,
    ViewOptions, shadow_ms, wgpu,
};
use shadowgraph_samples::demo::demo_scene;

/// Number of frames in the history of times.
const FRAMES: usize = 60;

/// The user's choices, and the state that follows from them.
pub(super) struct Stage {
    pub(super) scene: Scene,
    pub(super) registry: Registry,
    draw: DrawArgs,
    pub(super) technique: Technique,
    pub(super) pipeline: Pipeline,
    samples: u32,
    background: Background,
    culling: Culling,
    ground: GroundChoice,
    pub(super) aov: Aov,
    pub(super) settings: ShadowSettings,
    /// Lowers the quality of shadows while they exceed a time budget.
    pub(super) controller: Option<QualityController>,
    pub(super) fly: FlyCamera,
    pub(super) playback: Playback,
    /// `None` in a scene without directional lights.
    pub(super) sun: Option<Sun>,
    /// The camera that shadows are fitted to while it is frozen.
    shadow_camera: Option<Camera>,
    /// The lines over the image.
    pub(super) overlay: Option<ShadowLines>,
    /// The settings that change with time and place.
    pub(super) tracks: SettingTracks,
    pub(super) times: TimeHistory,
    /// The plan of the last valid frame.
    pub(super) plan: Option<Arc<Plan>>,
    /// What views of that frame draw that the GPU culls, of how many instances.
    pub(super) counts: (FrameCounts, usize),
    /// Error of the current frame, which keeps the last valid image.
    pub(super) error: Option<String>,
    /// Error of the last file that was loaded.
    pub(super) file_error: Option<String>,
    /// Message on the last action.
    pub(super) note: String,
    pub(super) settings_file: Option<PathBuf>,
    watched_settings: Watched,
    watched_pipeline: Watched,
    watched_shaders: Watched,
    renderer: Option<Renderer>,
    /// The pixel of the image that was clicked, until the next frame explains it.
    pub(super) picked: Option<[u32; 2]>,
    /// What the panel says about the last such pixel.
    pub(super) pixel: Option<String>,
    /// The page about the frames, if it is served.
    pub(super) live: Option<Live>,
    /// Records frames, if they are, while no renderer does.
    recorder: Option<Recorder>,
    record_mib: Option<u32>,
    /// The last requested renderer and the result, so that a failed one is not tried again.
    created: Option<(RendererKey, Result<(), String>)>,
}

/// Parameters of a renderer.
type RendererKey = (Technique, Pipeline, Aov);

impl Stage {
    pub(super) fn new(
        input: Input,
        view: ViewOptions,
        registry: Registry,
        args: &ViewArgs,
    ) -> Result<Self, Failure> {
        let radius_m = input.scene.bounds().radius();
        let shaders = args.draw.shaders.iter().flat_map(|folder| {
            shadowgraph::shaders::builtin_files().map(|file| folder.join(file)).collect::<Vec<_>>()
        });
        let settings_file = args.draw.settings_file().map(PathBuf::from);
        let selection = input.options.animation.resolve(&input.scene.hierarchy)?;
        let shadow_camera = shadow_camera(&input)?;
        Ok(Self {
            fly: FlyCamera::new(input.camera, radius_m),
            playback: Playback::new(selection, input.options.time.0),
            sun: Sun::from_scene(&input.scene, &input.options.sun),
            scene: input.scene,
            technique: input.options.render_config().technique(),
            registry,
            draw: args.draw.clone(),
            pipeline: input.options.pipeline,
            samples: input.options.samples,
            background: input.options.background,
            culling: input.options.culling,
            ground: input.options.ground,
            aov: input.options.aov,
            settings: view.shadows,
            controller: args.budget_ms.map(controller).transpose()?,
            shadow_camera,
            overlay: input.options.overlay,
            tracks: input.options.tracks,
            times: TimeHistory::new(FRAMES),
            plan: None,
            counts: Default::default(),
            error: None,
            file_error: None,
            note: String::new(),
            watched_settings: Watched::new(settings_file.clone()),
            settings_file,
            watched_pipeline: Watched::new(args.draw.pipeline_file().map(PathBuf::from)),
            watched_shaders: Watched::new(shaders),
            renderer: None,
            picked: None,
            pixel: None,
            live: None,
            recorder: input.recorder,
            record_mib: args.record.limit_mib(),
            created: None,
        })
    }

    /// Opens a scene, or the built-in one without a file, at its first camera. A failure changes nothing.
    pub(super) fn open(&mut self, file: Option<&Path>) {
        let loaded = file.map_or_else(|| Ok(demo_scene()), |file| load(file, None));
        let mut scene = match loaded {
            Ok(scene) => scene,
            Err(failure) => return self.file_error = Some(failure.message),
        };
        self.ground.place(&scene, true).add_to(&mut scene);
        self.recorder = self.record_mib.map(|limit_mib| {
            recording::recorder(&self.draw.with_scene(file.map(PathBuf::from), None, None), &scene, limit_mib)
        });
        let name = file.map_or("the built-in scene".into(), |file| file.display().to_string());
        self.note = SunChoice::default().apply(&mut scene).unwrap_or(name);
        let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(16.0 / 9.0));
        let view = ViewOptions { camera: camera.clone(), size_px: [16, 9], shadows: self.settings.clone() };
        self.settings = view.with_shadow_distance(ShadowDistance::Auto, &scene).shadows;
        self.fly = FlyCamera::new(camera, scene.bounds().radius());
        self.playback = Playback::new(AnimationSelection::All, 0.0);
        self.sun = Sun::from_scene(&scene, &SunChoice::default());
        (self.scene, self.aov, self.shadow_camera) = (scene, Aov::default(), None);
        (self.renderer, self.created, self.file_error) = (None, None, None);
    }

    /// Reloads files that were saved since the last frame.
    pub(super) fn reload(&mut self) {
        if self.watched_shaders.changed() {
            self.created = None;
            self.note = "reloaded the shaders".into();
        }
        if self.watched_pipeline.changed() {
            match self.draw.pipeline(&self.registry) {
                Ok(pipeline) => {
                    (self.pipeline, self.file_error) = (pipeline, None);
                    self.note = format!("reloaded {}", self.pipeline.name());
                    for warning in self.pipeline.warnings() {
                        self.note += &format!("; {warning}");
                    }
                }
                Err(error) => self.file_error = Some(error.to_string()),
            }
        }
        if self.watched_settings.changed()
            && let Some(file) = &self.settings_file
        {
            match SettingsFile::load(file, &self.registry.techniques) {
                Ok(read) => {
                    (self.settings, self.file_error) = (read.settings, None);
                    self.note = format!("reloaded {}", file.display());
                }
                Err(error) => self.file_error = Some(error.to_string()),
            }
        }
    }

    /// Follows what the page asks for, and returns the seconds by which the scene advances.
    pub(super) fn follow_page(&mut self, seconds: f64) -> f64 {
        let is_recording = self.record_mib.is_some();
        let Self { live: Some(live), technique, settings, registry, .. } = self else { return seconds };
        live.update(
            &mut Adjustable { technique, distance_m: &mut settings.distance_m, is_recording },
            registry,
        );
        live.advance(seconds)
    }

    /// Lets the sun move for some seconds, and follows its controls.
    pub(super) fn move_sun(&mut self, seconds: f64) -> Result<(), shadowgraph::Error> {
        let Some(sun) = &mut self.sun else { return Ok(()) };
        sun.advance(seconds);
        let Some(light) = sun.changed() else { return Ok(()) };
        let key = sun.key;
        if let Some(renderer) = &mut self.renderer {
            renderer.scene_mut().replace_light(key, light.clone())?;
        }
        self.scene.replace_light(key, light)?;
        Ok(())
    }

    /// Freezes the shadow camera, or lets it follow the camera again.
    pub(super) fn freeze(&mut self, frozen: bool) {
        self.shadow_camera = frozen.then(|| self.fly.camera().clone());
    }

    /// Returns whether the shadow camera is frozen.
    pub(super) fn is_frozen(&self) -> bool {
        self.shadow_camera.is_some()
    }

    /// Returns the current view options: the shadow settings of this time and place, limited by the time budget.
    fn options(&self, size_px: [u32; 2]) -> Result<ViewOptions, shadowgraph::Error> {
        let camera = self.fly.camera().clone();
        let shadows =
            self.tracks.settings_for(&self.settings, self.playback.time_s, camera.position_world())?;
        let shadows = match &self.controller {
            Some(controller) => controller.apply(&shadows),
            None => shadows,
        };
        Ok(ViewOptions { camera, size_px, shadows })
    }

    /// Returns the format of the target texture.
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

    /// Draws a frame into `target`. An error is stored in [`error`](Self::error), and the target is unchanged.
    pub(super) fn draw(&mut self, gpu: &Gpu, target: &wgpu::Texture) {
        match self.try_draw(gpu, target) {
            Ok(()) => self.error = None,
            Err(error) => self.error = Some(error.to_string()),
        }
    }

    fn try_draw(&mut self, gpu: &Gpu, target: &wgpu::Texture) -> Result<(), shadowgraph::Error> {
        self.update_renderer(gpu)?;
        let options = self.options([target.width(), target.height()])?;
        self.registry.techniques.check(&options.shadows)?;
        let Some(renderer) = &mut self.renderer else { return Ok(()) };
        renderer.set_shadow_camera(self.shadow_camera.clone());
        renderer.set_overlay(gpu, self.overlay)?;
        if let Err(error) = self.playback.apply([&mut self.scene, renderer.scene_mut()]) {
            self.file_error = Some(error.to_string());
        }
        self.explain_pixels(gpu, &options);
        let Some(renderer) = &mut self.renderer else { return Ok(()) };
        if let Some(live) = &mut self.live {
            live.begin_frame(&mut renderer.graph());
        }
        let mut timer = Timer::new();
        let (mut executed, counts) = gpu.checked(|| -> Result<_, shadowgraph::Error> {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let (executed, counts) =
                renderer.record_measured(gpu, &mut encoder, target, &options, &mut timer)?;
            gpu.queue.submit([encoder.finish()]);
            Ok((executed, counts.wait(&gpu.device)?))
        })?;
        let times = timer.read(&gpu.device, &gpu.queue)?;
        if let (Some(controller), Some(shadow_ms)) = (&mut self.controller, shadow_ms(&times)) {
            controller.update(shadow_ms);
        }
        self.times.add(&times);
        if let Some(live) = &mut self.live {
            live.end_frame(gpu, &mut executed, &times, renderer.graph().bytes());
        }
        self.plan = Some(executed.shared_plan());
        self.counts = (counts, renderer.casters().scene.instance_count());
        Ok(())
    }

    fn config(&self) -> RenderConfig {
        let (technique, pipeline) = (Some(self.technique), self.pipeline.clone());
        let (samples, background, culling) = (self.samples, self.background, self.culling);
        RenderConfig { technique, pipeline, samples, background, culling }
    }

    /// Explains the pixel that was clicked in the window, and that on the page.
    fn explain_pixels(&mut self, gpu: &Gpu, options: &ViewOptions) {
        let [width, height] = options.size_px;
        let on_page = self.live.as_mut().and_then(Live::take_pixel);
        for (pixel, is_on_page) in [(self.picked.take(), false), (on_page, true)] {
            let Some(pixel) = pixel.filter(|[x, y]| *x < width && *y < height) else { continue };
            let config = self.config();
            let Some(renderer) = &mut self.renderer else { continue };
            match pixel::explained(gpu, renderer, (options, &config), pixel) {
                Ok((history, shadows)) => match self.live.as_mut().filter(|_| is_on_page) {
                    Some(live) => live.answer_pixel(&history, &shadows.to_text()),
                    None => self.pixel = Some(format!("{}\n{}", history.to_text(), shadows.to_text())),
                },
                Err(failure) => self.file_error = Some(failure.message),
            }
        }
    }

    /// Creates the renderer for the current choices. On failure the previous one stays, with its image.
    fn update_renderer(&mut self, gpu: &Gpu) -> Result<(), shadowgraph::Error> {
        let key = (self.technique, self.pipeline.clone(), self.aov.clone());
        if let Some((_, created)) = self.created.as_ref().filter(|(last, _)| *last == key) {
            return created.clone().map_err(shadowgraph::Error::Gpu);
        }
        let config = self.config();
        let created = gpu.checked(|| {
            Renderer::with_config(gpu, self.scene.clone(), self.fly.camera(), self.aov.clone(), config)
        });
        let failed = created.as_ref().err().map(ToString::to_string);
        self.created = Some((key, failed.map_or(Ok(()), Err)));
        let mut created = created?;
        created.set_recorder(self.take_recorder());
        self.renderer = Some(created);
        Ok(())
    }

    /// Returns what has recorded the frames so far, if the page wants it saved.
    pub(super) fn recording_to_save(&mut self) -> Option<&Recorder> {
        let is_wanted = self.live.as_mut().is_some_and(Live::takes_recording);
        is_wanted.then(|| self.renderer.as_ref()?.recorder()).flatten()
    }

    /// Returns what has recorded the frames so far, and stops recording.
    pub(super) fn take_recorder(&mut self) -> Option<Recorder> {
        self.recorder.take().or_else(|| self.renderer.as_mut()?.take_recorder())
    }

    /// Returns the page of the current frame.
    pub(super) fn page(&mut self, gpu: &Gpu, size_px: [u32; 2]) -> Result<String, shadowgraph::Error> {
        let options = self.options(size_px)?;
        let lights = self.scene.lights().to_vec();
        let Some(renderer) = &mut self.renderer else { return Ok(String::new()) };
        Ok(renderer.inspect(gpu, &options)?.page(&lights, &options).to_html())
    }
}

/// Creates the controller of a time budget with the default levels.
fn controller(budget_ms: f64) -> Result<QualityController, OptionError> {
    let config = BudgetConfig { budget_ms, ..BudgetConfig::default() };
    QualityController::new(config).map_err(|error| OptionError::new("budget_ms", error.to_string()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn a_budget_is_a_number_of_milliseconds_in_a_range() {
        assert_eq!(controller(2.0).unwrap().level(), 0);
        for budget_ms in [0.0, -1.0, f64::NAN, 2e3] {
            let error = controller(budget_ms).unwrap_err().to_string();
            assert!(error.contains("budget_ms") && error.contains("0.001 to 1000"), "{error}");
        }
    }
}
