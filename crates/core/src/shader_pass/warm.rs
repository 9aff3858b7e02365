//! Meeting the cost of first draws before the first frame.

use crate::declaration::Origin;
use crate::desc::TextureDesc;
use crate::error::Error;
use crate::frame::Frame;
use crate::graph::Graph;
use crate::pool::Physical;

impl Graph {
    /// Runs a frame once for nothing but what it makes drivers do: drawing with a pipeline for the first time can
    /// take a third of a second, since many drivers translate shaders only then. Afterwards a frame of the same
    /// passes takes as long as any other.
    ///
    /// Declare the frame as you would to show it, by the same function; a smaller size will do, as what is compiled
    /// depends on formats and shaders alone. Every pass that is not culled runs, so your own pipelines in bodies are
    /// warmed like those of one-line passes.
    ///
    /// It is executed with textures and buffers of its own, submitted and waited for, and leaves nothing behind but
    /// the pipelines and the plan: histories stay as they were, and imports that the frame writes are stood in for by
    /// copies that hold zeros, so that nothing of yours is drawn into. Only what bodies do by themselves is done.
    ///
    #[doc = include_str!("warm.md")]
    ///
    /// # Errors
    /// As compiling and executing the frame.
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
        self.device.take_pipelines(scratch.device);
        let _executed = executed?;
        queue.submit([encoder.finish()]);
        // It fails with a lost device, of which wgpu tells the caller.
        let _ = device.poll(wgpu::PollType::wait_indefinitely());
        Ok(())
    }
}

/// Puts objects of the same shape and usages in the place of imports that the frame writes.
fn replace_written_imports(frame: &mut Frame<'_>, device: &wgpu::Device) {
    for (resource, import) in frame.decl.resources.iter().zip(&mut frame.work.imports) {
        let written = resource.version > 0 && matches!(resource.origin, Origin::Imported { .. });
        if let Some(import) = import.as_mut().filter(|_| written) {
            *import = like(import, device);
        }
    }
}

fn like(object: &Physical, device: &wgpu::Device) -> Physical {
    let label = Some("warm");
    match object {
        Physical::Texture(texture) => {
            let TextureDesc { size, format, mip_levels, samples, dimension } = TextureDesc::of(texture);
            Physical::Texture(device.create_texture(&wgpu::TextureDescriptor {
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
        Physical::Buffer(buffer) => Physical::Buffer(device.create_buffer(&wgpu::BufferDescriptor {
            label,
            size: buffer.size(),
            usage: buffer.usage(),
            mapped_at_creation: false,
        })),
    }
}
