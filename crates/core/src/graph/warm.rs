//! Warming up pipelines before the first frame.

use super::Graph;
use crate::declaration::Origin;
use crate::desc::TextureDesc;
use crate::error::Error;
use crate::frame::Frame;
use crate::pool::PhysicalResource;

impl Graph {
    /// Runs a frame once so that drivers compile its shaders: drawing with a pipeline for the first time can take a third
    /// of a second, since many drivers compile only then. Afterwards a frame of the same passes takes its usual time.
    ///
    /// Declare the frame as you would to show it, by the same function. A smaller size is enough, since compilation
    /// depends on formats and shaders only. Every pass that is not culled runs, so your own pipelines in bodies are warmed
    /// up like those of one-line passes.
    ///
    /// The frame is executed with separate textures and buffers, submitted and waited for, and leaves only the pipelines
    /// and the plan behind: histories are unchanged, and imports that the frame writes are replaced by textures and
    /// buffers of zeros, so that none of your objects is drawn into. Side effects of bodies do happen.
    ///
    #[doc = include_str!("warm.md")]
    ///
    /// # Errors
    /// The errors of compiling and executing the frame.
    pub fn warm(
        &mut self,
        mut frame: Frame<'_>,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<(), Error> {
        replace_written_imports(&mut frame, device);
        let compiled = self.compile(frame)?;
        let mut scratch = Graph::new();
        scratch.device = self.device.lend_pipelines();
        let mut encoder =
            device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("warm") });
        let executed = compiled.execute(&mut scratch, device, &mut encoder);
        self.device.return_pipelines(scratch.device);
        let _executed = executed?;
        queue.submit([encoder.finish()]);
        // Polling fails only on a lost device, which wgpu reports to the caller.
        let _ = device.poll(wgpu::PollType::wait_indefinitely());
        Ok(())
    }
}

/// Replaces imports that the frame writes by objects of the same shape and usages.
fn replace_written_imports(frame: &mut Frame<'_>, device: &wgpu::Device) {
    for (resource, import) in frame.decl.resources.iter().zip(&mut frame.work.imports) {
        let written = resource.version > 0 && matches!(resource.origin, Origin::Imported { .. });
        if let Some(import) = import.as_mut().filter(|_| written) {
            *import = create_like(import, device);
        }
    }
}

fn create_like(object: &PhysicalResource, device: &wgpu::Device) -> PhysicalResource {
    let label = Some("warm");
    match object {
        PhysicalResource::Texture(texture) => {
            let TextureDesc { size, format, mip_levels, samples, dimension } =
                TextureDesc::from_texture(texture);
            PhysicalResource::Texture(device.create_texture(&wgpu::TextureDescriptor {
                label,
                size,
                mip_level_count: mip_levels,
                sample_count: samples,
                dimension,
                format,
                usage: texture.usage(),
                view_formats: &[],
            }))
        }
        PhysicalResource::Buffer(buffer) => {
            PhysicalResource::Buffer(device.create_buffer(&wgpu::BufferDescriptor {
                label,
                size: buffer.size(),
                usage: buffer.usage(),
                mapped_at_creation: false,
            }))
        }
    }
}
