//! Drawing a scene: what stays from frame to frame.

mod draw;
mod record;
mod shown;

pub(crate) use draw::nothing_read;
use shown::lit_output;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DVec3;
use shadowgraph_core::{Format, Graph, Plan};
use shadowgraph_lighting::{AmbientLight, KeyLight, LitOutput, LitTarget};
use shadowgraph_scene::gpu::GpuScene;
use shadowgraph_scene::{Camera, Light, Scene, origin_near};
use shadowgraph_shadows::{ShadowTechnique, Unshadowed};

use crate::options::Aov;
use crate::pipelines::{Build, View, Wiring};
use crate::{Error, Gpu, Method, Pipeline, SceneCasters, Show, ViewOptions, techniques};

/// Draws one scene by one method.
pub struct Renderer {
    pub(crate) casters: SceneCasters,
    pub(crate) technique: Box<dyn ShadowTechnique>,
    method: Method,
    wiring: Box<dyn Wiring>,
    show: Show,
    output: LitOutput,
    scene: Scene,
    aov: Aov,
    /// Whose view shadows are made for, where that is not the one who looks.
    pub(crate) shadow_camera: Option<Camera>,
    /// A frame borrows the renderer while the graph compiles and records it.
    graph: Mutex<Graph>,
}

/// The format of finished pictures.
pub(crate) const PICTURE_FORMAT: Format = Format::Rgba8UnormSrgb;

impl Renderer {
    /// Uploads a scene and makes the pipelines for pictures of `aov`. GPU space is relative to a point near
    /// `eye` until a view moves it.
    ///
    /// # Errors
    /// Names the limit of the device that the scene is over, or the light that `aov` asks for and that is not there.
    pub fn new(gpu: &Gpu, scene: Scene, eye: &Camera, aov: Aov) -> Result<Self, Error> {
        Self::with(gpu, scene, eye, aov, Method::default())
    }

    /// Is like [`new`](Self::new), by another method than the default one.
    ///
    /// # Errors
    /// As `new`; for `raytraced` also a scene whose triangles or alpha textures do not fit the device's buffers; for a number
    /// of samples that cannot be.
    pub fn with(
        gpu: &Gpu,
        scene: Scene,
        eye: &Camera,
        aov: Aov,
        method: impl Into<Method>,
    ) -> Result<Self, Error> {
        let mut method = method.into();
        if !matches!(method.samples, 1 | 4) {
            return Err(Error::Samples { samples: method.samples });
        }
        if aov != Aov::Color {
            // Data is not mixed.
            method.samples = 1;
        }
        Self::on(gpu, scene, origin_near(eye.position_world()), aov, method)
    }

    /// Makes anew on another device all that this renderer has on its own, to go on after [`DeviceLost`]: the scene and what it
    /// is drawn by stay, what passes kept from frame to frame is forgotten. Give up the lost device's [`Gpu`] for another
    /// by [`Gpu::open`].
    ///
    /// ```
    /// use shadowgraph::options::Aov;
    /// use shadowgraph::scene::demo::demo_scene;
    /// use shadowgraph::{Gpu, Renderer, ViewOptions};
    /// # let open = Gpu::noop;
    /// let (mut gpu, scene) = (open()?, demo_scene());
    /// let camera = scene.cameras[0].clone();
    /// let mut renderer = Renderer::new(&gpu, scene, &camera, Aov::Color)?;
    /// let options = ViewOptions { camera, size_px: [64, 36], shadows: Default::default() };
    /// # gpu.device.destroy();
    /// let mut drawn = renderer.draw(&gpu, &options);
    /// if let Err(shadowgraph::Error::Graph(shadowgraph::core::Error::DeviceLost)) = drawn {
    ///     gpu = open()?;
    ///     renderer.move_to(&gpu)?;
    ///     drawn = renderer.draw(&gpu, &options);
    /// }
    /// assert!(drawn.is_ok());
    /// # Ok::<(), shadowgraph::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`with`](Self::with); the renderer is as it was then.
    ///
    /// [`DeviceLost`]: shadowgraph_core::Error::DeviceLost
    pub fn move_to(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let (scene, origin_world) = (self.scene.clone(), self.casters.scene.origin_world());
        let moved = Self::on(gpu, scene, origin_world, self.aov.clone(), self.method.clone())?;
        *self = Self { shadow_camera: self.shadow_camera.take(), ..moved };
        Ok(())
    }

    fn on(gpu: &Gpu, scene: Scene, origin_world: DVec3, aov: Aov, method: Method) -> Result<Self, Error> {
        gpu.checked(|| Self::unchecked(gpu, scene, origin_world, aov, method))
    }

    fn unchecked(
        gpu: &Gpu,
        scene: Scene,
        origin_world: DVec3,
        aov: Aov,
        method: Method,
    ) -> Result<Self, Error> {
        let device = &gpu.device;
        let method = Method { pipeline: method.pipeline.on(gpu.adapter.device_type)?, ..method };
        let uploaded = GpuScene::new(device, &gpu.queue, &scene, origin_world)?;
        let technique = techniques::make(&method, gpu, &scene, origin_world)?;
        let (output, format) = lit_output(&aov, &scene.lights)?;
        let lit = LitTarget { format, output, samples: method.samples };
        let layouts = uploaded.layouts();
        let wiring = method.pipeline.make(&Build { device, layouts, technique: technique.as_ref(), lit })?;
        Ok(Self {
            casters: SceneCasters::new(device, uploaded)?,
            technique,
            method,
            wiring,
            show: Show::new(device)?,
            output,
            scene,
            aov,
            shadow_camera: None,
            graph: Mutex::default(),
        })
    }

    /// Returns the scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Puts other lights in the place of the scene's, for instance to move the sun.
    ///
    /// # Errors
    /// If pictures show the visibility of a light that is not among them.
    pub fn set_lights(&mut self, lights: Vec<Light>) -> Result<(), Error> {
        lit_output(&self.aov, &lights)?;
        self.scene.lights = lights;
        Ok(())
    }

    /// Makes shadows for this camera's view, whoever looks, so that they can be seen from outside; `None`: for the view that
    /// is drawn.
    pub fn set_shadow_camera(&mut self, camera: Option<Camera>) {
        self.shadow_camera = camera;
    }

    /// Returns the scene on the GPU, as shadow casters.
    pub fn casters(&self) -> &SceneCasters {
        &self.casters
    }

    /// Returns the pipeline that draws.
    pub fn pipeline(&self) -> &Pipeline {
        &self.method.pipeline
    }

    /// Returns how many samples each pixel has while it is drawn.
    pub fn samples(&self) -> u32 {
        self.method.samples
    }

    /// Returns what pictures show.
    pub(crate) fn aov(&self) -> &Aov {
        &self.aov
    }

    /// Compiles the frame of a view without drawing it. Any device will do, [`Gpu::noop`] too.
    ///
    /// # Errors
    /// Settings out of range, or a camera that sees nothing.
    pub fn plan(&self, options: &ViewOptions) -> Result<(Arc<Plan>, Vec<Unshadowed>), Error> {
        options.camera.check(options.aspect())?;
        let view = self.view(options, None);
        let mut frame = self.graph().frame();
        let output = self.add(&mut frame, &view)?;
        frame.export_texture(&output.picture);
        Ok((self.graph().compile(frame)?.shared_plan(), output.unshadowed))
    }

    /// Culls and sorts what the view sees. A colour picture goes to `target`.
    pub(crate) fn view<'v>(
        &'v self,
        options: &'v ViewOptions,
        target: Option<&'v wgpu::Texture>,
    ) -> View<'v> {
        let gpu_scene = &self.casters.scene;
        let mut seen = Vec::new();
        gpu_scene.cull(&options.camera.frustum(options.aspect()).into(), &mut seen);
        let draws = gpu_scene.draw_list(&seen, options.camera.position_world());
        let key = KeyLight::estimate(&self.scene.lights, gpu_scene.bounds());
        View {
            number: 0,
            options,
            draws,
            ambient_light: AmbientLight::for_key_light(key),
            lights: &self.scene.lights,
            casters: &self.casters,
            technique: self.technique.as_ref(),
            shadow_camera: self.shadow_camera.as_ref().unwrap_or(&options.camera),
            output: self.output,
            target: target.filter(|_| self.aov == Aov::Color),
        }
    }

    /// Checks the camera, and moves GPU space to it.
    pub(crate) fn move_origin(&mut self, gpu: &Gpu, options: &ViewOptions) -> Result<(), Error> {
        options.camera.check(options.aspect())?;
        let origin_world = origin_near(options.camera.position_world());
        if origin_world == self.casters.scene.origin_world() {
            return Ok(());
        }
        self.casters.scene.set_origin(&gpu.queue, &self.scene, origin_world);
        // It may hold positions.
        self.technique = techniques::make(&self.method, gpu, &self.scene, origin_world)?;
        Ok(())
    }

    /// What outlives frames; hold it for no longer than one call.
    pub(crate) fn graph(&self) -> MutexGuard<'_, Graph> {
        self.graph.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests;
