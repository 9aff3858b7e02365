//! One-line passes: their output on a device that draws, and their caches and errors on wgpu's noop device.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod caches;
mod compute;
mod errors;
mod pixels;
mod warm;

use crate::test_device::valid;
use crate::{
    ComputeShader, Contents, Executed, Format, Frame, FullscreenShader, Graph, ReadBackRequest, Subresource,
};
use crate::{Texture, TextureDesc};

const TEXT: &str = include_str!("../../../tests/shader_passes.wgsl");

fn fragment(entry: &'static str) -> FullscreenShader {
    FullscreenShader::wgsl(entry, TEXT).entry_point(entry)
}

fn kernel(entry: &'static str) -> ComputeShader {
    ComputeShader::wgsl(entry, TEXT).entry_point(entry)
}

struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    graph: Graph,
}

impl Gpu {
    fn new((device, queue): (wgpu::Device, wgpu::Queue)) -> Self {
        Self { device, queue, graph: Graph::new() }
    }

    fn noop() -> Self {
        Self::new(crate::test_device::noop())
    }

    fn drawing() -> Option<Self> {
        crate::test_device::drawing().map(Self::new)
    }

    /// Compiles and records a frame.
    fn record(&mut self, frame: Frame<'_>) -> Result<(Executed, wgpu::CommandEncoder), crate::Error> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let compiled = self.graph.compile(frame)?;
        let executed = compiled.execute(&mut self.graph, &self.device, &mut encoder)?;
        Ok((executed, encoder))
    }

    /// Compiles, records and submits a frame, and fails on a validation error of wgpu.
    fn run(&mut self, frame: Frame<'_>) -> Result<Executed, crate::Error> {
        let device = self.device.clone();
        valid(&device, || {
            let (executed, encoder) = self.record(frame)?;
            self.queue.submit([encoder.finish()]);
            Ok(executed)
        })
    }

    /// Runs the frame and returns what it reads back.
    fn bytes<const N: usize>(&mut self, frame: Frame<'_>, requests: [ReadBackRequest; N]) -> [Vec<u8>; N] {
        let mut executed = self.run(frame).unwrap();
        requests.map(|request| executed.read_back(request).unwrap().wait(&self.device).unwrap())
    }

    /// Returns the numbers of cached render pipelines, compute pipelines and bind groups.
    fn cached(&self) -> (usize, usize, usize) {
        let caches = self.graph.device.caches();
        let (render, compute) = caches.pipelines.len();
        (render, compute, caches.bind_groups.len())
    }
}

fn texture(frame: &mut Frame<'_>, name: &str, side: u32, format: Format) -> Texture {
    frame.create_texture(name, TextureDesc::d2(side, side, format))
}

/// Declares a texture cleared to grey of this level.
fn cleared(frame: &mut Frame<'_>, name: &str, side: u32, level: f64) -> Texture {
    let mut image = texture(frame, name, side, Format::Rgba8Unorm);
    frame.render_pass(name).color(&mut image, Contents::clear_color([level; 4]));
    image
}

fn whole(frame: &mut Frame<'_>, texture: &Texture) -> ReadBackRequest {
    frame.read_back_texture(texture, Subresource::FULL)
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
}
