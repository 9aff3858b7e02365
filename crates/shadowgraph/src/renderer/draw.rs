//! Images that are drawn and read back.

use shadowgraph_core::{Buffer, Compiled, Executed, Graph, ResourceId, Subresource, Timer};
use shadowgraph_shadows::ShadowOutputs;

use super::Renderer;
use super::counts::{CountRequests, read_back_error};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::render_view::RenderView;
use crate::rendered::{RenderedFrame, RenderedImage};
use crate::view_options::ViewOptions;

/// A drawn view, and resources of its frame.
pub(crate) struct Drawn {
    pub(crate) frame: RenderedFrame,
    /// The image.
    pub(crate) image: ResourceId,
    /// The GPU data of shadow maps, if there are any.
    pub(crate) shadow_buffers: Option<[Buffer; 2]>,
}

impl Renderer {
    /// Draws a view and reads the image back.
    ///
    /// # Errors
    /// For settings out of range, an invalid camera, an image that exceeds the adapter's limits, and errors of wgpu: after
    /// [`OutOfMemory`](shadowgraph_core::Error::OutOfMemory) smaller images and shadow maps can be drawn, and after
    /// [`DeviceLost`](shadowgraph_core::Error::DeviceLost) the renderer can be [recreated](Self::recreate_on) on another device.
    pub fn draw(&mut self, gpu: &Gpu, options: &ViewOptions) -> Result<RenderedFrame, Error> {
        self.draw_timed(gpu, options, None)
    }

    /// Draws a view like [`draw`](Self::draw), and measures every pass with `timer`.
    ///
    /// # Errors
    /// As `draw`.
    pub fn draw_timed(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        mut timer: Option<&mut Timer>,
    ) -> Result<RenderedFrame, Error> {
        let is_first = self.frames == 0;
        let Drawn { mut frame, .. } =
            self.draw_with(gpu, options, |compiled, graph| match timer.as_deref_mut() {
                // Its pipelines are created as its passes are recorded.
                None if is_first => Ok(compiled.execute_submitted(graph, &gpu.device, &gpu.queue)?),
                None => gpu.submit(|encoder| Ok(compiled.execute(graph, &gpu.device, encoder)?)),
                Some(timer) => {
                    gpu.submit(|encoder| Ok(compiled.execute_timed(graph, &gpu.device, encoder, timer)?))
                }
            })?;
        if let Some(timer) = timer {
            frame.times = timer.read(&gpu.device, &gpu.queue)?;
        }
        Ok(frame)
    }

    /// Draws a view whose frame `execute` executes and submits.
    pub(crate) fn draw_with(
        &mut self,
        gpu: &Gpu,
        options: &ViewOptions,
        execute: impl FnOnce(Compiled<'_>, &mut Graph) -> Result<Executed, Error>,
    ) -> Result<Drawn, Error> {
        let [width, height] = options.size_px;
        let limit = gpu.device.limits().max_texture_dimension_2d;
        if width.max(height) > limit {
            return Err(Error::ImageSize { width, height, limit });
        }
        self.begin_frame(gpu, options)?;
        let view = self.view(options, None);
        let drawn = gpu.checked(|| {
            let mut frame = self.graph().frame();
            let output = self.add(&mut frame, &view)?;
            let request = frame.read_back_texture(&output.image, Subresource::FULL);
            let counts = CountRequests::new(&mut frame);
            let mut graph = self.graph();
            let compiled = graph.compile(frame)?;
            let mut executed = execute(compiled, &mut graph)?;
            drop(graph);
            let texels = executed.read_back(request).ok_or_else(read_back_error)?;
            let counts = counts.take(&mut executed).wait(&gpu.device)?;
            let image = RenderedImage { size_px: options.size_px, rgba8: texels.wait(&gpu.device)? };
            let values = executed.take_values().map(|values| values.wait(&gpu.device)).transpose()?;
            let (plan, times) = (executed.shared_plan(), Vec::new());
            let ShadowOutputs { unshadowed, map_buffers: shadow_buffers, .. } = output.shadows;
            let frame = RenderedFrame { image, plan, times, unshadowed, counts, values };
            Ok(Drawn { frame, image: output.image.id(), shadow_buffers })
        });
        self.end_frame(drawn.is_ok(), &[options]);
        drawn
    }

    /// Draws several views in one frame, such as the halves of a split screen or two eyes. Each has its own shadow maps. The
    /// images are in the order of the views.
    ///
    /// # Errors
    /// As [`draw`](Self::draw), and for views that are too far apart, kilometres, to share one GPU space.
    pub fn draw_views(&mut self, gpu: &Gpu, views: &[ViewOptions]) -> Result<Vec<RenderedImage>, Error> {
        let Some(first) = views.first() else { return Ok(Vec::new()) };
        self.begin_frame(gpu, first)?;
        let planned: Vec<RenderView<'_>> = (0u32..)
            .zip(views)
            .map(|(index, options)| RenderView { index, ..self.view(options, None) })
            .collect();
        let drawn = gpu.checked(|| {
            let mut frame = self.graph().frame();
            planned.iter().for_each(|view| view.add_pose(&mut frame));
            let mut requests = Vec::new();
            for view in &planned {
                let name = format_args!("view {}", view.index);
                let output = frame.node(name, |frame| self.add(frame, view))?;
                requests.push(frame.read_back_texture(&output.image, Subresource::FULL));
            }
            let mut executed = gpu.submit(|encoder| self.execute(frame, gpu, encoder, None))?;
            let texels: Option<Vec<_>> =
                requests.into_iter().map(|request| executed.read_back(request)).collect();
            let texels = texels.ok_or_else(read_back_error)?;
            let images = views.iter().zip(texels).map(|(options, texels)| {
                Ok(RenderedImage { size_px: options.size_px, rgba8: texels.wait(&gpu.device)? })
            });
            images.collect()
        });
        self.end_frame(drawn.is_ok(), &views.iter().collect::<Vec<_>>());
        drawn
    }
}
