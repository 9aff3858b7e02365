//! A history: noise that is averaged over frames. The graph keeps the contents for the next frame, and reports whether they are valid.
//!
//! `cargo run -p shadowgraph-examples --example temporal` writes out/temporal.png after 64 frames; `-- --frames 1` shows the noise
//! of one frame, and `-- --window` how it converges.

use shadowgraph::Gpu;
use shadowgraph::core::{Format, FullscreenShader, Graph, Resize, TextureDesc};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use std::process::ExitCode;

/// Samples of a disc's penumbra, one per frame: one frame is noisy, the mean of many is smooth.
const ACCUMULATE: &str = "
    @group(0) @binding(0) var before: texture_2d<f32>;
    // The number of the frame, and its weight in the mean.
    @group(0) @binding(1) var<uniform> frame: vec2f;

    fn noise(p: vec3f) -> f32 {
        return fract(sin(dot(p, vec3f(12.9898, 78.233, 37.719))) * 43758.5453);
    }

    @fragment
    fn accumulate(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
        let here = (uv - 0.5) * vec2f(16.0, 9.0) / 9.0;
        let angle = 6.2831853 * noise(vec3f(position.xy, frame.x));
        let jitter = vec2f(cos(angle), sin(angle)) * 0.12 * sqrt(noise(vec3f(position.yx, frame.x + 0.5)));
        let visibility = f32(length(here + jitter) > 0.3);
        let mean = textureLoad(before, vec2u(position.xy), 0).r;
        return vec4f(mix(mean, visibility, frame.y));
    }";

const SHOW: &str = "
    @group(0) @binding(0) var mean: texture_2d<f32>;

    @fragment
    fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
        return vec4f(textureLoad(mean, vec2u(position.xy), 0).rrr, 1.0);
    }";

struct Mean {
    graph: Graph,
    accumulate: FullscreenShader,
    show: FullscreenShader,
    /// The number of frames in the mean.
    frames: u32,
}

impl Example for Mean {
    const NAME: &'static str = "temporal";
    const SIZE_PX: [u32; 2] = [320, 180];
    const FRAMES: u32 = 64;

    fn new(_gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        let accumulate = FullscreenShader::wgsl("accumulate", ACCUMULATE);
        let show = FullscreenShader::wgsl("show", SHOW);
        Ok(Self { graph: Graph::new(), accumulate, show, frames: 0 })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, number, .. }: Canvas<'_>) -> Result<(), Failure> {
        let desc = TextureDesc::d2(target.width(), target.height(), Format::R32Float);
        let mut frame = self.graph.frame();
        let mut mean = frame.history("mean", desc, Resize::Reset);
        // After a resize there are no previous contents, and the mean starts again.
        self.frames = if mean.valid { self.frames + 1 } else { 1 };
        let block = [number as f32, 1.0 / self.frames as f32].map(f32::to_le_bytes).concat();
        let pass = frame.fullscreen("accumulate", &self.accumulate);
        pass.sample(&mean.previous).uniform(&block[..]).draw(&mut mean.current);
        let mut image = frame.import_texture("image", target, false);
        frame.fullscreen("show", &self.show).sample(&mean.current).draw(&mut image);
        self.graph.compile(frame)?.execute(&mut self.graph, &gpu.device, encoder)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<Mean>()
}
