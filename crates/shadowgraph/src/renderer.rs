//! Drawing a scene: the state that is kept from frame to frame.

pub(crate) mod aov;
pub(crate) mod counts;
mod draw;
mod record;

use aov::lit_output;
pub(crate) use draw::Drawn;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DVec3;
use shadowgraph_core::{Graph, Plan};
use shadowgraph_lighting::{
    AmbientLight, KeyLight, KeyLightEstimate, LitOutput, LitTarget, PosePass, PreviousCameras,
};
use shadowgraph_scene::gpu::GpuScene;
use shadowgraph_scene::{Aabb, Camera, Changes, GroundPlane, Scene, origin_near};
use shadowgraph_shadows::{ShadowTechnique, TechniqueContext, Unshadowed};

use crate::background::Background;
use crate::build_context::BuildContext;
use crate::casters::SceneCasters;
use crate::debug_blit::DebugBlit;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::options::aov::Aov;
use crate::pipelines::instance::PipelineInstance;
use crate::pipelines::pipeline::Pipeline;
use crate::recording::{Recorder, RendererState};
use crate::render_config::RenderConfig;
use crate::render_view::RenderView;
use crate::scene_rays::UploadedRays;
use crate::shadow_lines::{ShadowLines, ShadowLinesPass};
use crate::view_options::ViewOptions;

/// Draws one scene with one configuration.
pub struct Renderer {
    casters: SceneCasters,
    technique: Box<dyn ShadowTechnique>,
    config: RenderConfig,
    instance: Box<dyn PipelineInstance>,
    debug_blit: DebugBlit,
    /// The lines over images that show what shadow maps cover.
    overlay: Option<ShadowLinesPass>,
    pose: PosePass,
    lit_output: LitOutput,
    scene: Scene,
    key_light: KeyLight,
    key_light_estimate: KeyLightEstimate,
    aov: Aov,
    /// The camera that shadows are fitted to, if it is not that of the view.
    shadow_camera: Option<Camera>,
    previous_cameras: PreviousCameras,
    /// The number of frames that were drawn or recorded.
    frames: u32,
    recorder: Option<Recorder>,
    /// Guarded by a mutex because a frame borrows the renderer while the graph compiles and executes it.
    graph: Mutex<Graph>,
}

impl Renderer {
    /// Uploads a scene and builds the default pipeline for images of `aov`. GPU space is relative to a point near
    /// `eye` until a view moves it.
    ///
    /// # Errors
    /// For a scene that exceeds a limit of the device, and for an unknown light in `aov`.
    pub fn new(gpu: &Gpu, scene: Scene, eye: &Camera, aov: Aov) -> Result<Self, Error> {
        Self::with_config(gpu, scene, eye, aov, RenderConfig::default())
    }

    /// Creates a renderer like [`new`](Self::new), with another configuration than the default.
    ///
    /// # Errors
    /// As `new`, and for an unsupported sample count; for `raytraced` also for a scene whose triangles or alpha textures do not fit
    /// the device's buffers.
    pub fn with_config(
        gpu: &Gpu,
        scene: Scene,
        eye: &Camera,
        aov: Aov,
        config: impl Into<RenderConfig>,
    ) -> Result<Self, Error> {
        Self::at_origin(gpu, scene, origin_near(eye.position_world()), aov, config.into())
    }

    /// Creates a renderer like [`with_config`](Self::with_config), with an origin of GPU space.
    pub(crate) fn at_origin(
        gpu: &Gpu,
        scene: Scene,
        origin_world: DVec3,
        aov: Aov,
        mut config: RenderConfig,
    ) -> Result<Self, Error> {
        if !matches!(config.samples, 1 | 4) {
            return Err(Error::SampleCount { samples: config.samples });
        }
        if aov != Aov::Color {
            // Data must not be averaged.
            config.samples = 1;
        }
        Self::create(gpu, scene, origin_world, aov, config)
    }

    /// Recreates the renderer on another device after [`DeviceLost`]. Scene and configuration stay; what passes kept from frame to
    /// frame is lost. Replace the [`Gpu`] of the lost device with a new one from [`Gpu::open`].
    ///
    /// ```
    /// use shadowgraph::options::Aov;
    /// use shadowgraph_samples::demo::demo_scene;
    /// use shadowgraph::{Gpu, Renderer, ViewOptions};
    /// # let open = Gpu::noop;
    /// let (mut gpu, scene) = (open()?, demo_scene());
    /// let camera = scene.cameras[0].clone();
    /// let mut renderer = Renderer::new(&gpu, scene, &camera, Aov::Color)?;
    /// let options = ViewOptions { camera, size_px: [64, 36], shadows: Default::default() };
    /// # gpu.device.destroy();
    /// let mut result = renderer.draw(&gpu, &options);
    /// if let Err(shadowgraph::Error::Graph(shadowgraph::core::Error::DeviceLost)) = result {
    ///     gpu = open()?;
    ///     renderer.recreate_on(&gpu)?;
    ///     result = renderer.draw(&gpu, &options);
    /// }
    /// assert!(result.is_ok());
    /// # Ok::<(), shadowgraph::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`with_config`](Self::with_config); the renderer is as it was then.
    ///
    /// [`DeviceLost`]: shadowgraph_core::Error::DeviceLost
    pub fn recreate_on(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let (scene, origin_world) = (self.scene.clone(), self.casters.scene.origin_world());
        let created = Self::create(gpu, scene, origin_world, self.aov.clone(), self.config.clone())?;
        let (overlay, recorder) = (self.overlay(), self.recorder.take());
        *self = Self { shadow_camera: self.shadow_camera.take(), ..created };
        self.set_recorder(recorder);
        self.set_overlay(gpu, overlay)
    }

    fn create(
        gpu: &Gpu,
        scene: Scene,
        origin_world: DVec3,
        aov: Aov,
        config: RenderConfig,
    ) -> Result<Self, Error> {
        gpu.checked(|| Self::create_unchecked(gpu, scene, origin_world, aov, config))
    }

    fn create_unchecked(
        gpu: &Gpu,
        mut scene: Scene,
        origin_world: DVec3,
        aov: Aov,
        config: RenderConfig,
    ) -> Result<Self, Error> {
        let device = &gpu.device;
        let uploaded = upload(gpu, &mut scene, origin_world)?;
        let technique = create_technique(&config, gpu)?;
        let rays = upload_rays(technique.as_ref(), gpu, &scene, origin_world)?;
        let (lit_output, format) = lit_output(&aov, scene.lights())?;
        let lit = LitTarget { format, output: lit_output, samples: config.samples };
        let layouts = uploaded.layouts();
        let instance =
            config.pipeline.build(&BuildContext { device, layouts, technique: technique.as_ref(), lit })?;
        let mut casters = SceneCasters::new(device, uploaded)?;
        casters.rays = rays;
        let mut renderer = Self {
            casters,
            technique,
            config,
            instance,
            debug_blit: DebugBlit::new(device)?,
            overlay: None,
            pose: PosePass::new(device)?,
            lit_output,
            scene,
            key_light: KeyLight::default(),
            key_light_estimate: KeyLightEstimate::default(),
            aov,
            shadow_camera: None,
            previous_cameras: PreviousCameras::default(),
            frames: 0,
            recorder: None,
            graph: Mutex::default(),
        };
        renderer.follow_scene();
        Ok(renderer)
    }

    /// Returns the scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the scene for edits between frames. The next frame follows them: it uploads what changed, and nothing else. To draw
    /// another scene, use [`set_scene`](Self::set_scene).
    ///
    /// ```
    /// use glam::{DAffine3, DVec3};
    /// use shadowgraph::options::Aov;
    /// use shadowgraph::{Gpu, Renderer, ViewOptions};
    /// use shadowgraph_samples::demo::demo_scene;
    /// # let gpu = Gpu::noop()?;
    /// let scene = demo_scene();
    /// let camera = scene.cameras[0].clone();
    /// let (vase, _) = scene.instances().find(|(_, instance)| instance.name == "garden vase").unwrap();
    /// let mut renderer = Renderer::new(&gpu, scene, &camera, Aov::Color)?;
    /// let options = ViewOptions { camera, size_px: [64, 36], shadows: Default::default() };
    /// for frame in 0..3 {
    ///     let up = DAffine3::from_translation(DVec3::Y * f64::from(frame) * 0.1);
    ///     renderer.scene_mut().edit_instance(vase, |vase| vase.world_from_local = up * vase.world_from_local)?;
    ///     renderer.draw(&gpu, &options)?;
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn scene_mut(&mut self) -> &mut Scene {
        &mut self.scene
    }

    /// Replaces the scene by another one, and forgets what was kept from frame to frame. Pipelines stay, so this takes less time than a
    /// new renderer.
    ///
    /// # Errors
    /// As [`with_config`](Self::with_config); the renderer is as it was then.
    pub fn set_scene(&mut self, gpu: &Gpu, mut scene: Scene) -> Result<(), Error> {
        let origin_world = self.casters.scene.origin_world();
        let (lit_output, _) = lit_output(&self.aov, scene.lights())?;
        let (uploaded, technique, rays) = gpu.checked(|| {
            let uploaded = upload(gpu, &mut scene, origin_world)?;
            let technique = create_technique(&self.config, gpu)?;
            let rays = upload_rays(technique.as_ref(), gpu, &scene, origin_world)?;
            Ok::<_, Error>((uploaded, technique, rays))
        })?;
        (self.casters.scene, self.casters.rays, self.technique) = (uploaded, rays, technique);
        (self.scene, self.lit_output) = (scene, lit_output);
        (self.previous_cameras, self.graph) = (PreviousCameras::default(), Mutex::default());
        self.frames = 0;
        self.recorder.iter_mut().for_each(|recorder| recorder.end("the scene was replaced"));
        self.follow_scene();
        Ok(())
    }

    /// Records all frames from now on, or none. The renderer must not have drawn a frame yet, and be one of the scene of the recorder with any
    /// edits of what recordings have; else the recording ends at once, as [`Recorder::ended_because`] says. A recorder that was
    /// [taken](Self::take_recorder) continues with a second renderer, such as one of another technique.
    pub fn set_recorder(&mut self, mut recorder: Option<Recorder>) {
        if let Some(recorder) = &mut recorder {
            if self.frames > 0 {
                recorder.end("the renderer has drawn frames before");
            }
            recorder.begin_renderer(&self.state());
        }
        self.recorder = recorder;
    }

    /// Returns what recorders read.
    fn state(&self) -> RendererState<'_> {
        RendererState {
            scene: &self.scene,
            config: &self.config,
            aov: &self.aov,
            origin_world: self.casters.scene.origin_world(),
            shadow_camera: self.shadow_camera.as_ref(),
            overlay: self.overlay(),
        }
    }

    /// Returns the recorder.
    pub fn recorder(&self) -> Option<&Recorder> {
        self.recorder.as_ref()
    }

    /// Stops recording, and returns the recorder.
    pub fn take_recorder(&mut self) -> Option<Recorder> {
        self.recorder.take()
    }

    /// Fits shadows to this camera instead of the view's, so that they can be seen from outside; `None` for the view's camera.
    pub fn set_shadow_camera(&mut self, camera: Option<Camera>) {
        self.shadow_camera = camera;
    }

    /// Draws lines over all images that show what shadow maps cover, or none. With [another camera for shadows](Self::set_shadow_camera) they
    /// are seen from outside. A technique without maps has none.
    ///
    /// # Errors
    /// None with the built-in WGSL.
    pub fn set_overlay(&mut self, gpu: &Gpu, lines: Option<ShadowLines>) -> Result<(), Error> {
        if lines != self.overlay() {
            self.overlay = lines.map(|kind| ShadowLinesPass::new(&gpu.device, kind)).transpose()?;
        }
        Ok(())
    }

    /// Returns the lines over images.
    pub fn overlay(&self) -> Option<ShadowLines> {
        self.overlay.as_ref().map(ShadowLinesPass::kind)
    }

    /// Returns the scene on the GPU, as shadow casters.
    pub fn casters(&self) -> &SceneCasters {
        &self.casters
    }

    /// Returns the pipeline.
    pub fn pipeline(&self) -> &Pipeline {
        &self.config.pipeline
    }

    /// Returns the configuration.
    pub fn config(&self) -> &RenderConfig {
        &self.config
    }

    /// Returns the number of frames that were drawn or recorded.
    pub(crate) fn frame_number(&self) -> u32 {
        self.frames
    }

    /// Returns the number of samples per pixel.
    pub fn samples(&self) -> u32 {
        self.config.samples
    }

    /// Returns the shadow technique.
    pub fn technique(&self) -> &dyn ShadowTechnique {
        self.technique.as_ref()
    }

    /// Returns the camera that shadows are fitted to, if it is not that of the view.
    pub fn shadow_camera(&self) -> Option<&Camera> {
        self.shadow_camera.as_ref()
    }

    /// Returns the AOV of the images.
    pub fn aov(&self) -> &Aov {
        &self.aov
    }

    /// Compiles the frame of a view without drawing it. It works on any device, also on [`Gpu::noop`].
    ///
    /// # Errors
    /// For settings out of range, and for an invalid camera.
    pub fn plan(&self, options: &ViewOptions) -> Result<(Arc<Plan>, Vec<Unshadowed>), Error> {
        options.camera.check(options.aspect())?;
        let view = self.view(options, None);
        let mut frame = self.graph().frame();
        let output = self.add(&mut frame, &view)?;
        frame.export_texture(&output.image);
        Ok((self.graph().compile(frame)?.shared_plan(), output.shadows.unshadowed))
    }

    /// Culls and sorts the geometry of a view that the CPU culls, for [`add`](Self::add) and for other passes over it. `target` is the target of a colour
    /// image. The view borrows the renderer, so that the scene cannot be edited while a frame is recorded:
    ///
    /// ```compile_fail,E0502
    /// # use shadowgraph::{Renderer, ViewOptions};
    /// fn record(renderer: &mut Renderer, options: &ViewOptions) {
    ///     let view = renderer.view(options, None);
    ///     let scene = renderer.scene_mut();
    ///     drop(view);
    /// }
    /// ```
    pub fn view<'v>(&'v self, options: &'v ViewOptions, target: Option<&'v wgpu::Texture>) -> RenderView<'v> {
        let gpu_scene = &self.casters.scene;
        let mut visible = Vec::new();
        let volume = options.camera.frustum(options.aspect()).into();
        if self.casters.culls_on_gpu() {
            gpu_scene.cull_blended(&volume, &mut visible);
        } else {
            gpu_scene.cull(&volume, &mut visible);
        }
        let draws = gpu_scene.draw_list(&visible, options.camera.position_world());
        RenderView {
            index: 0,
            options,
            draws,
            key_light: self.key_light,
            ambient_light: AmbientLight::for_key_light(self.key_light),
            lights: self.scene.lights(),
            ground: self.ground(),
            background: self.background(),
            casters: &self.casters,
            pose: &self.pose,
            technique: self.technique.as_ref(),
            shadow_camera: self.shadow_camera.as_ref().unwrap_or(&options.camera),
            previous_cameras: &self.previous_cameras,
            lit_output: self.lit_output,
            noise_frame: self.instance.is_temporal().then_some(self.frames),
            target: target.filter(|_| self.aov == Aov::Color),
        }
    }

    /// Returns the ground of the scene, if the images show it.
    fn ground(&self) -> Option<GroundPlane> {
        self.scene.ground.filter(|_| self.aov == Aov::Color && self.config.pipeline.has_sky())
    }

    /// Returns what is drawn behind the scene; in images that are not in colour, the sky.
    fn background(&self) -> Background {
        if self.aov == Aov::Color { self.config.background } else { Background::Sky }
    }

    /// Begins a frame: checks the camera, gives the scene the [shadow modes](Scene::set_shadow_modes) of the settings, follows its edits, and moves the origin of GPU space to the camera.
    /// Drawing and recording begin with it.
    ///
    /// # Errors
    /// [`Error::Camera`]; [`Error::UnknownLight`] if the AOV is the visibility of a light that was removed; for edits that exceed a
    /// limit of the device, until they are undone.
    pub fn begin_frame(&mut self, gpu: &Gpu, options: &ViewOptions) -> Result<(), Error> {
        options.camera.check(options.aspect())?;
        (self.lit_output, _) = lit_output(&self.aov, self.scene.lights())?;
        if self.scene.shadow_modes() != (&options.shadows.materials, &options.shadows.objects) {
            self.scene.set_shadow_modes(options.shadows.shadow_modes());
        }
        let changes = self.scene.take_changes();
        let origin_world = origin_near(options.camera.position_world());
        let followed = self.follow(gpu, &changes, origin_world);
        match &followed {
            Ok(()) => self.recorder.iter_mut().for_each(|recorder| recorder.follow(&self.scene, &changes)),
            Err(_) => self.scene.restore_changes(changes),
        }
        self.follow_scene();
        followed
    }

    /// Chooses what depends on the uploaded scene: what culls, the key light, and where the ground has shadows.
    fn follow_scene(&mut self) {
        let bounds = self.casters.scene.bounds();
        self.key_light = self.key_light_estimate.update(self.scene.lights(), bounds);
        self.casters.culling = self.config.culling.choose(&self.casters.scene);
        let casters = self.casters.scene.all_caster_bounds();
        let lights = self.scene.lights();
        self.casters.ground_shadows =
            self.ground().map_or(Aabb::EMPTY, |ground| ground.shadow_bounds(&casters, lights));
    }

    /// Follows edits, and moves the origin.
    fn follow(&mut self, gpu: &Gpu, changes: &Changes, origin_world: DVec3) -> Result<(), Error> {
        let Self { scene, casters, .. } = self;
        let (device, queue) = (&gpu.device, &gpu.queue);
        let is_still = changes.is_empty() && casters.scene.origin_world() == origin_world;
        let mut update = || {
            casters.scene.update(device, queue, scene, changes)?;
            casters.scene.set_origin(device, queue, scene, origin_world)?;
            if let Some(rays) = &mut casters.rays {
                rays.update(gpu, scene, changes, origin_world)?;
            }
            Ok(())
        };
        if is_still { update() } else { gpu.checked(update) }
    }

    /// Ends a frame of some views: records it, if it was drawn, and moves on to the next frame's noise.
    fn end_frame(&mut self, drawn: bool, views: &[&ViewOptions]) {
        if let Some(mut recorder) = self.recorder.take() {
            if drawn {
                recorder.add_frame(&self.state(), views);
            }
            self.recorder = Some(recorder);
        }
        self.frames = self.frames.wrapping_add(1);
    }

    /// Locks the graph, which keeps plans, pooled resources and histories from frame to frame. Drawing waits while the guard is held.
    pub fn graph(&self) -> MutexGuard<'_, Graph> {
        self.graph.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Uploads a scene with all its edits.
fn upload(gpu: &Gpu, scene: &mut Scene, origin_world: DVec3) -> Result<GpuScene, Error> {
    let uploaded = GpuScene::new(&gpu.device, &gpu.queue, scene, origin_world)?;
    let _uploaded = scene.take_changes();
    Ok(uploaded)
}

fn create_technique(config: &RenderConfig, gpu: &Gpu) -> Result<Box<dyn ShadowTechnique>, Error> {
    let technique = config.technique();
    let technique = if config.pipeline.has_screen_shadows() { technique.with_screen() } else { technique };
    Ok(technique.make(&TechniqueContext::new(&gpu.device))?)
}

/// Uploads the triangles of a scene for a technique that traces rays.
fn upload_rays(
    technique: &dyn ShadowTechnique,
    gpu: &Gpu,
    scene: &Scene,
    origin_world: DVec3,
) -> Result<Option<UploadedRays>, Error> {
    let rays = || UploadedRays::new(gpu, scene, origin_world);
    Ok(technique.traces_rays().then(rays).transpose()?)
}

#[cfg(test)]
mod tests;
