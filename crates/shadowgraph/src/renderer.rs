//! Drawing a scene: what stays from frame to frame.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use glam::DVec3;
use shadowgraph_core::{Buffer, Compiled, Executed, Format, Frame, Graph, Part, Plan, Texture, Timer};
use shadowgraph_lighting::{Ambience, Key, LitTarget, Shows};
use shadowgraph_scene::gpu::GpuScene;
use shadowgraph_scene::{Camera, Light, Scene, origin_near};
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique, Unshadowed};

use crate::options::Aov;
use crate::picture::{Drawn, Picture};
use crate::pipelines::{Build, Output, View, Wiring};
use crate::{Error, Gpu, Method, Pipeline, SceneCasters, Show, ViewOptions, techniques};

/// Draws one scene by one method.
pub struct Renderer {
    pub(crate) casters: SceneCasters,
    pub(crate) technique: Box<dyn ShadowTechnique>,
    method: Method,
    wiring: Box<dyn Wiring>,
    show: Show,
    shows: Shows,
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
        let (shows, format) = shows(&aov, &scene.lights)?;
        let lit = LitTarget { format, shows, samples: method.samples };
        let layouts = uploaded.layouts();
        let wiring = method.pipeline.make(&Build { device, layouts, technique: technique.as_ref(), lit })?;
        Ok(Self {
            casters: SceneCasters::new(device, uploaded)?,
            technique,
            method,
            wiring,
            show: Show::new(device)?,
            shows,
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
        shows(&self.aov, &lights)?;
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

    /// Draws a view and reads the picture back.
    ///
    /// # Errors
    /// Settings out of range, a camera that sees nothing, a picture over the adapter's limits, or a failure of the GPU: after
    /// [`OutOfMemory`](shadowgraph_core::Error::OutOfMemory) smaller pictures and shadow maps can be drawn, and after
    /// [`DeviceLost`](shadowgraph_core::Error::DeviceLost) the renderer can [move](Self::move_to) to another device.
    pub fn draw(&mut self, gpu: &Gpu, options: &ViewOptions) -> Result<Drawn, Error> {
        self.draw_timed(gpu, options, None)
    }

    /// Draws like [`draw`](Self::draw) and measures every pass with `timer`.
    ///
    /// # Errors
    /// As `draw`.
    pub fn draw_timed(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        mut timer: Option<&mut Timer>,
    ) -> Result<Drawn, Error> {
        let (mut drawn, _) = self.draw_by(gpu, options, |compiled, graph, encoder| {
            Ok(match timer.as_deref_mut() {
                Some(timer) => compiled.execute_timed(graph, &gpu.device, encoder, timer)?,
                None => compiled.execute(graph, &gpu.device, encoder)?,
            })
        })?;
        if let Some(timer) = timer {
            drawn.times = timer.read(&gpu.device, &gpu.queue)?;
        }
        Ok(drawn)
    }

    /// Draws a view whose frame `record` records, and returns with it the records of its shadow maps.
    pub(crate) fn draw_by(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        record: impl FnOnce(Compiled<'_>, &mut Graph, &mut wgpu::CommandEncoder) -> Result<Executed, Error>,
    ) -> Result<(Drawn, Option<[Buffer; 2]>), Error> {
        let [width, height] = options.size_px;
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if width.max(height) > limit {
            return Err(Error::PictureSize { width, height, limit });
        }
        self.move_origin(gpu, options)?;
        let view = self.view(options, None);
        gpu.checked(|| {
            let mut frame = self.graph().frame();
            let output = self.add(&mut frame, &view)?;
            let request = frame.read_back_texture(&output.picture, Part::WHOLE);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut graph = self.graph();
            let compiled = graph.compile(frame)?;
            let mut executed = record(compiled, &mut graph, &mut encoder)?;
            drop(graph);
            let texels = executed.read_back(request).ok_or_else(nothing_read)?;
            gpu.queue.submit([encoder.finish()]);
            let picture = Picture { size_px: options.size_px, rgba8: texels.wait(&gpu.device)? };
            let (plan, times) = (executed.shared_plan(), Vec::new());
            Ok((Drawn { picture, plan, times, unshadowed: output.unshadowed }, output.records))
        })
    }

    /// Draws several views in one frame, such as the halves of a split screen or two eyes: each has its own shadow maps. The
    /// pictures come in the order of the views.
    ///
    /// # Errors
    /// As [`draw`](Self::draw); views whose GPU space cannot be the same, as they are kilometres apart.
    pub fn draw_views(&mut self, gpu: &Gpu, views: &[ViewOptions]) -> Result<Vec<Picture>, Error> {
        let Some(first) = views.first() else { return Ok(Vec::new()) };
        self.move_origin(gpu, first)?;
        let planned: Vec<View<'_>> = (0u32..)
            .zip(views)
            .map(|(number, options)| View { number, ..self.view(options, None) })
            .collect();
        gpu.checked(|| {
            let mut frame = self.graph().frame();
            let mut requests = Vec::new();
            for view in &planned {
                let name = format_args!("view {}", view.number);
                let output = frame.node(name, |frame| self.add(frame, view))?;
                requests.push(frame.read_back_texture(&output.picture, Part::WHOLE));
            }
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut executed = self.execute(frame, gpu, &mut encoder, None)?;
            let texels: Option<Vec<_>> =
                requests.into_iter().map(|request| executed.read_back(request)).collect();
            gpu.queue.submit([encoder.finish()]);
            let texels = texels.ok_or_else(nothing_read)?;
            let pictures = views.iter().zip(texels).map(|(options, texels)| {
                Ok(Picture { size_px: options.size_px, rgba8: texels.wait(&gpu.device)? })
            });
            pictures.collect()
        })
    }

    /// Records a view into an encoder of the caller's, who submits it. The picture covers `target`, such as a
    /// window's surface, and is as large as it; `options.size_px` is not looked at. Colours need a target of an
    /// sRGB format with `RENDER_ATTACHMENT`; other outputs are copied, so they need `Rgba8Unorm` (textures that are
    /// not depth: `Rgba8UnormSrgb`) with `COPY_DST`.
    ///
    /// The returned frame holds the plan.
    ///
    /// # Errors
    /// Settings out of range, or a target that does not fit.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::Texture,
        options: &ViewOptions,
    ) -> Result<Executed, Error> {
        self.record_timed(gpu, encoder, target, options, None)
    }

    /// Records like [`record`](Self::record) and measures every pass with `timer`: read it when the encoder is
    /// submitted.
    ///
    /// # Errors
    /// As `record`.
    pub fn record_timed(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::Texture,
        options: &ViewOptions,
        timer: Option<&mut Timer>,
    ) -> Result<Executed, Error> {
        let options = options_for(target, options);
        self.check_target(target.format())?;
        self.move_origin(gpu, &options)?;
        let view = self.view(&options, Some(target));
        let mut frame = self.graph().frame();
        self.add_into(&mut frame, &view, target)?;
        self.execute(frame, gpu, encoder, timer)
    }

    /// Records several views in one frame, each into a target of its own, such as the halves of a split screen or two eyes: each
    /// has its own shadow maps.
    ///
    /// # Errors
    /// As [`record`](Self::record); views whose GPU space cannot be the same, as they are kilometres apart.
    pub fn record_views(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        views: &[(&wgpu::Texture, &ViewOptions)],
    ) -> Result<Executed, Error> {
        let all: Vec<_> = views.iter().map(|(target, options)| options_for(target, options)).collect();
        views.iter().try_for_each(|(target, _)| self.check_target(target.format()))?;
        if let Some(first) = all.first() {
            self.move_origin(gpu, first)?;
        }
        let planned: Vec<(View<'_>, &wgpu::Texture)> = (0u32..)
            .zip(all.iter().zip(views))
            .map(|(number, (options, (target, _)))| {
                (View { number, ..self.view(options, Some(target)) }, *target)
            })
            .collect();
        let mut frame = self.graph().frame();
        for (view, target) in &planned {
            let name = format_args!("view {}", view.number);
            frame.node(name, |frame| self.add_into(frame, view, target))?;
        }
        self.execute(frame, gpu, encoder, None)
    }

    /// Adds the passes of a view whose picture goes to `target`.
    fn add_into<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        target: &wgpu::Texture,
    ) -> Result<(), Error> {
        let output = self.add(frame, view)?;
        if self.aov != Aov::Color {
            let mut target = frame.import_texture("target", target, false);
            frame.copy_pass("copy to target").texture(&output.picture, &mut target);
        }
        Ok(())
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

    /// Adds the passes of a view, and those that show what is asked for.
    pub(crate) fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Shown, Error> {
        let output = self.wiring.add(frame, view)?;
        let picture = self.shown(frame, view, &output)?;
        let ShadowOutputs { records, unshadowed, .. } = output.shadows;
        Ok(Shown { picture, records, unshadowed })
    }

    /// What is asked for; passes that it does not need are culled.
    fn shown<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        output: &Output<'f>,
    ) -> Result<Texture, Error> {
        let none = |output| Error::NoOutput {
            aov: self.aov.to_string(),
            pipeline: self.method.pipeline.name().into(),
            output,
        };
        let size_px = view.options.size_px;
        let buffers = || output.view.as_ref().ok_or_else(|| none("view"));
        match &self.aov {
            Aov::Color => Ok(output.picture.clone()),
            Aov::Visibility(_) | Aov::Cascade | Aov::Normal => {
                output.light.clone().ok_or_else(|| none("light"))
            }
            Aov::Depth => {
                let depth = output.depth.as_ref().ok_or_else(|| none("depth"))?;
                let buffers = buffers()?;
                Ok(frame.node("picture", |frame| self.show.depth(frame, buffers, depth, size_px)))
            }
            Aov::Atlas => {
                let maps: Vec<&Texture> = output.shadows.debug.iter().map(|(_, texture)| texture).collect();
                let buffers = buffers()?;
                Ok(frame.node("picture", |frame| self.show.textures(frame, buffers, &maps, size_px)))
            }
            Aov::Texture(name) => {
                let texture = frame.find_texture(name).ok_or_else(|| no_texture(frame, name))?;
                has_picture(frame, &texture, name)?;
                let buffers = buffers()?;
                Ok(frame.node("picture", |frame| self.show.textures(frame, buffers, &[&texture], size_px)))
            }
        }
    }

    /// Culls and sorts what the view sees. A colour picture goes to `target`.
    pub(crate) fn view<'v>(
        &'v self,
        options: &'v ViewOptions,
        target: Option<&'v wgpu::Texture>,
    ) -> View<'v> {
        let gpu_scene = &self.casters.scene;
        let mut seen = Vec::new();
        gpu_scene.cull(&options.camera.volume(options.aspect()).into(), &mut seen);
        let draws = gpu_scene.draw_list(&seen, options.camera.position_world());
        let key = Key::of(&self.scene.lights, gpu_scene.bounds());
        View {
            number: 0,
            options,
            draws,
            ambience: Ambience::for_key(key),
            lights: &self.scene.lights,
            casters: &self.casters,
            technique: self.technique.as_ref(),
            shadow_camera: self.shadow_camera.as_ref().unwrap_or(&options.camera),
            shows: self.shows,
            target: target.filter(|_| self.aov == Aov::Color),
        }
    }

    /// Pictures of colours need a format that encodes them.
    fn check_target(&self, format: Format) -> Result<(), Error> {
        if self.aov == Aov::Color && !format.is_srgb() {
            return Err(Error::TargetFormat { format });
        }
        Ok(())
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

    /// Compiles and records a frame; one that is declared like one before has its plan, textures and bind groups.
    fn execute(
        &self,
        frame: Frame<'_>,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        timer: Option<&mut Timer>,
    ) -> Result<Executed, Error> {
        let mut graph = self.graph();
        let compiled = graph.compile(frame)?;
        Ok(match timer {
            Some(timer) => compiled.execute_timed(&mut graph, &gpu.device, encoder, timer)?,
            None => compiled.execute(&mut graph, &gpu.device, encoder)?,
        })
    }
}

/// The options of a view that is as large as its target.
fn options_for(target: &wgpu::Texture, options: &ViewOptions) -> ViewOptions {
    ViewOptions { size_px: [target.width(), target.height()], ..options.clone() }
}

/// What a view gives.
pub(crate) struct Shown {
    /// Four bytes a pixel, as large as the view.
    pub(crate) picture: Texture,
    /// The records of shadow maps, where there are any.
    pub(crate) records: Option<[Buffer; 2]>,
    /// The lights that are to cast shadows but have none, and why.
    pub(crate) unshadowed: Vec<Unshadowed>,
}

/// An error for textures of whole numbers.
fn has_picture(frame: &Frame<'_>, texture: &Texture, name: &str) -> Result<(), Error> {
    let desc = frame.texture_desc(texture);
    let Some(format) = desc.map(|desc| desc.format).filter(|format| !format.is_depth_stencil_format()) else {
        return Ok(());
    };
    match format.sample_type(None, None) {
        Some(wgpu::TextureSampleType::Float { .. }) => Ok(()),
        _ => Err(Error::NoPicture { name: name.into(), format }),
    }
}

fn no_texture(frame: &Frame<'_>, name: &str) -> Error {
    let known: Vec<_> = frame.texture_names().collect();
    Error::NoTexture { name: name.into(), known: known.join(", ") }
}

/// A read-back is taken out once, by the frame that asked for it.
pub(crate) fn nothing_read() -> Error {
    Error::Gpu("nothing was read back".into())
}

/// What the lit pass writes for an output, and in which format.
fn shows(aov: &Aov, lights: &[Light]) -> Result<(Shows, Format), Error> {
    Ok(match aov {
        Aov::Visibility(light) if *light as usize >= lights.len() => {
            let there_are = match lights.len() {
                0 => "the scene has no light".into(),
                1 => "the scene has one light, 0".into(),
                count => format!("the scene has lights 0 to {}", count - 1),
            };
            return Err(Error::NoLight { light: *light, there_are });
        }
        Aov::Visibility(light) => (Shows::Visibility(*light), Format::Rgba8Unorm),
        Aov::Cascade => (Shows::Debug, Format::Rgba8Unorm),
        Aov::Normal => (Shows::Normal, Format::Rgba8Unorm),
        Aov::Color | Aov::Depth | Aov::Atlas | Aov::Texture(_) => (Shows::Light, Format::Rgba16Float),
    })
}

#[cfg(test)]
mod tests;
