//! Recording with a check of each step, so that a validation error of wgpu names its pass.

use super::Executed;
use super::stepwise::record_steps;
use crate::compiled::Compiled;
use crate::error::Error;
use crate::graph::Graph;
use crate::plan::Plan;
use std::sync::Arc;

/// A frame that could not be recorded, with its plan.
#[derive(Debug, thiserror::Error)]
#[error("{error}")]
pub struct FailedFrame {
    /// The error, with the pass that it is in.
    #[source]
    pub error: Error,
    /// The plan of the frame, to be inspected, for example with [`Plan::to_text`].
    pub plan: Arc<Plan>,
}

impl Compiled<'_> {
    /// Records and submits the frame like [`execute`](Self::execute), but each step in a separate command buffer, and stops
    /// at the first with a validation error: the error names its passes and is returned with the plan. It is meant for
    /// debugging, since it costs a command buffer for every step and waits for wgpu's validation of each.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, TextureDesc};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// let mut graph = Graph::new();
    /// let mut frame = graph.frame();
    /// let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    /// let mut pass = frame.render_pass("draws without a pipeline");
    /// pass.color(&mut color, Contents::clear_color([0.0; 4]));
    /// pass.body(|ctx| {
    ///     ctx.pass.draw(0..3, 0..1);
    ///     Ok(())
    /// });
    /// frame.export_texture(&color);
    /// let failed = graph.compile(frame)?.execute_checked(&mut graph, &device, &queue).err().ok_or("it draws")?;
    /// assert!(failed.to_string().starts_with("SG0606: wgpu validation error in `draws without a pipeline` ("));
    /// println!("{}", failed.plan.to_text());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Validation`] for a validation error of wgpu; otherwise as `execute`. Nothing is submitted then.
    pub fn execute_checked(
        self,
        graph: &mut Graph,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<Executed, Box<FailedFrame>> {
        let plan = self.plan.clone();
        record(self, graph, device, queue).map_err(|error| {
            let error = graph.device.classify_error(device, error);
            Box::new(FailedFrame { error, plan })
        })
    }
}

fn record(
    compiled: Compiled<'_>,
    graph: &mut Graph,
    device: &wgpu::Device,
    queue: &wgpu::Queue,
) -> Result<Executed, Error> {
    let mut buffers = Vec::new();
    let executed = record_steps(compiled, &mut graph.device, device, true, |buffer| buffers.push(buffer))?;
    queue.submit(buffers);
    Ok(executed)
}
