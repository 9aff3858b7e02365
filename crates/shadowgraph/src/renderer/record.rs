//! Views that are recorded into an encoder of the caller's.

use shadowgraph_core::{Executed, Format, Frame, Timer};

use super::Renderer;
use crate::options::Aov;
use crate::pipelines::View;
use crate::{Error, Gpu, ViewOptions};

impl Renderer {
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

    /// Pictures of colours need a format that encodes them.
    fn check_target(&self, format: Format) -> Result<(), Error> {
        if self.aov == Aov::Color && !format.is_srgb() {
            return Err(Error::TargetFormat { format });
        }
        Ok(())
    }

    /// Compiles and records a frame; one that is declared like one before has its plan, textures and bind groups.
    pub(super) fn execute(
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
