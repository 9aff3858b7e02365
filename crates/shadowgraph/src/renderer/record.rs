//! Views that are recorded into an encoder of the caller.

use shadowgraph_core::{Executed, Format, Frame, Timer};

use super::Renderer;
use super::counts::{CountRequests, PendingCounts};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::options::aov::Aov;
use crate::render_view::RenderView;
use crate::view_options::ViewOptions;

impl Renderer {
    /// Records a view into the caller's encoder, for the caller to submit. The image covers `target`, such as a window's
    /// surface texture; `options.size_px` is ignored. Colours need a target of an sRGB format with `RENDER_ATTACHMENT`; other
    /// AOVs are copied, so they need `Rgba8Unorm` (textures that are not depth: `Rgba8UnormSrgb`) with `COPY_DST`.
    ///
    /// The result holds the plan.
    ///
    /// # Errors
    /// For settings out of range, and for a target of another format.
    pub fn record(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::Texture,
        options: &ViewOptions,
    ) -> Result<Executed, Error> {
        self.record_view(gpu, target, options, |frame, renderer| renderer.execute(frame, gpu, encoder, None))
    }

    /// Records a view like [`record`](Self::record), measures every pass with `timer`, which is read when the encoder is submitted, and
    /// reads back what the GPU counts.
    ///
    /// # Errors
    /// As `record`.
    pub fn record_measured(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::Texture,
        options: &ViewOptions,
        timer: &mut Timer,
    ) -> Result<(Executed, PendingCounts), Error> {
        self.record_view(gpu, target, options, |mut frame, renderer| {
            let requests = CountRequests::new(&mut frame);
            let mut executed = renderer.execute(frame, gpu, encoder, Some(timer))?;
            let counts = requests.take(&mut executed);
            Ok((executed, counts))
        })
    }

    /// Declares the frame of a view, which `execute` executes.
    fn record_view<T>(
        &mut self,
        gpu: &Gpu,
        target: &wgpu::Texture,
        options: &ViewOptions,
        execute: impl FnOnce(Frame<'_>, &Self) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let options = options_for(target, options);
        self.check_target(target.format())?;
        self.begin_frame(gpu, &options)?;
        let view = self.view(&options, Some(target));
        let mut frame = self.graph().frame();
        self.add_into(&mut frame, &view, target)?;
        let executed = execute(frame, self);
        self.end_frame(executed.is_ok(), &[&options]);
        executed
    }

    /// Records several views in one frame, each into its own target, such as the halves of a split screen or two eyes. Each has
    /// its own shadow maps.
    ///
    /// # Errors
    /// As [`record`](Self::record), and for views that are too far apart, kilometres, to share one GPU space.
    pub fn record_views(
        &mut self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        views: &[(&wgpu::Texture, &ViewOptions)],
    ) -> Result<Executed, Error> {
        let all: Vec<_> = views.iter().map(|(target, options)| options_for(target, options)).collect();
        views.iter().try_for_each(|(target, _)| self.check_target(target.format()))?;
        if let Some(first) = all.first() {
            self.begin_frame(gpu, first)?;
        }
        let planned: Vec<(RenderView<'_>, &wgpu::Texture)> = (0u32..)
            .zip(all.iter().zip(views))
            .map(|(index, (options, (target, _)))| {
                (RenderView { index, ..self.view(options, Some(target)) }, *target)
            })
            .collect();
        let mut frame = self.graph().frame();
        planned.iter().for_each(|(view, _)| view.add_pose(&mut frame));
        for (view, target) in &planned {
            let name = format_args!("view {}", view.index);
            frame.node(name, |frame| self.add_into(frame, view, target))?;
        }
        let executed = self.execute(frame, gpu, encoder, None);
        self.end_frame(executed.is_ok(), &all.iter().collect::<Vec<_>>());
        executed
    }

    /// Adds the passes of a view, and the copy to `target` if the AOV is not drawn into it.
    fn add_into<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        target: &wgpu::Texture,
    ) -> Result<(), Error> {
        let output = self.add(frame, view)?;
        if self.aov != Aov::Color {
            let mut target = frame.import_texture("target", target, false);
            frame.copy_pass("copy to target").texture(&output.image, &mut target);
        }
        Ok(())
    }

    /// Refuses formats that do not encode colours.
    fn check_target(&self, format: Format) -> Result<(), Error> {
        if self.aov == Aov::Color && !format.is_srgb() {
            return Err(Error::TargetFormat { format });
        }
        Ok(())
    }

    /// Compiles and executes a frame; a frame that is declared like an earlier one reuses its plan, textures and bind groups.
    pub(crate) fn execute(
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

/// Returns the options of a view with the size of its target.
fn options_for(target: &wgpu::Texture, options: &ViewOptions) -> ViewOptions {
    ViewOptions { size_px: [target.width(), target.height()], ..options.clone() }
}
