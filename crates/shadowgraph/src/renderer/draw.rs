//! Pictures that are drawn and read back.

use shadowgraph_core::{Buffer, Compiled, Executed, Graph, Subresource, Timer};

use super::Renderer;
use crate::picture::{Drawn, Picture};
use crate::pipelines::View;
use crate::{Error, Gpu, ViewOptions};

impl Renderer {
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
            let request = frame.read_back_texture(&output.picture, Subresource::FULL);
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
                requests.push(frame.read_back_texture(&output.picture, Subresource::FULL));
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
}

/// A read-back is taken out once, by the frame that asked for it.
pub(crate) fn nothing_read() -> Error {
    Error::Gpu("nothing was read back".into())
}
