//! Recording each step into a separate command buffer.

use super::Executed;
use super::record::prepare;
use crate::compiled::Compiled;
use crate::context::{Bodies, Recording};
use crate::device::with_error_scopes;
use crate::error::Error;
use crate::graph::Graph;
use crate::handle::PassId;
use crate::pool::Pool;

impl Compiled<'_> {
    /// Records the frame like [`execute`](Self::execute), and submits each step as soon as it is recorded.
    ///
    /// The GPU begins while later steps are recorded. It is meant for the first frame of a program: drivers that compile shaders
    /// when they are first drawn with compile while the pipelines of later passes are created. It costs a submission for each step.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, TextureDesc};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// let mut graph = Graph::new();
    /// for is_first in [true, false] {
    ///     let mut frame = graph.frame();
    ///     let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    ///     frame.render_pass("sky").color(&mut color, Contents::clear_color([0.2, 0.4, 0.8, 1.0]));
    ///     frame.export_texture(&color);
    ///     let compiled = graph.compile(frame)?;
    ///     if is_first {
    ///         compiled.execute_submitted(&mut graph, &device, &queue)?;
    ///     } else {
    ///         let mut encoder = device.create_command_encoder(&Default::default());
    ///         compiled.execute(&mut graph, &device, &mut encoder)?;
    ///         queue.submit([encoder.finish()]);
    ///     }
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As `execute`. The steps before the failed one are submitted then.
    pub fn execute_submitted(
        self,
        graph: &mut Graph,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Executed, Error> {
        if graph.records_in_order() {
            let mut encoder = device.create_command_encoder(&Default::default());
            let executed = self.execute(graph, device, &mut encoder)?;
            queue.submit([encoder.finish()]);
            return Ok(executed);
        }
        let pool = &mut graph.device;
        let submit = |buffer| {
            queue.submit([buffer]);
        };
        record_steps(self, pool, device, false, submit).map_err(|error| pool.classify_error(device, error))
    }
}

/// Records the frame and passes the command buffers on in order: that of the uploads, one for each step and that of the read-backs.
/// With `checks`, it stops at the first step with a validation error of wgpu, which names its passes.
pub(super) fn record_steps(
    mut compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    checks: bool,
    mut pass_on: impl FnMut(wgpu::CommandBuffer),
) -> Result<Executed, Error> {
    let encoder = || device.create_command_encoder(&Default::default());
    let (mut first, mut last) = (encoder(), encoder());
    let mut bodies = std::mem::take(&mut compiled.frame.work.bodies);
    let prepared = prepare(&compiled, pool, device, &mut first, Some(&last))?;
    let recording = prepared.recording(&compiled, pool, device, None);
    pass_on(first.finish());
    for (index, step) in compiled.plan.steps().enumerate() {
        let record = || {
            let mut encoder = encoder();
            let recorded = recording.steps(index..index + 1, &mut encoder, Bodies::OfFrame(&mut bodies));
            (recorded, encoder.finish())
        };
        let filters: &[_] = if checks { &[wgpu::ErrorFilter::Validation] } else { &[] };
        let ((recorded, buffer), error) = with_error_scopes(device, filters, record);
        recorded?;
        if let Some(error) = error {
            return Err(in_passes(&recording, step.passes, &error));
        }
        pass_on(buffer);
    }
    let read_backs = recording.read_backs(&compiled.frame.work.read_backs, &mut last)?;
    compiled.frame.work.bodies = bodies;
    pass_on(last.finish());
    Ok(prepared.finish(compiled, pool, read_backs))
}

fn in_passes(recording: &Recording<'_>, passes: &[PassId], error: &wgpu::Error) -> Error {
    let names: Vec<String> = passes.iter().map(|&pass| recording.pass_name(pass).to_string()).collect();
    let message = error.to_string();
    let lines: Vec<&str> = message.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    Error::Validation { passes: names.join(", "), message: lines.join("; ") }
}
