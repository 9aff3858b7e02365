//! A history: noise that is averaged over frames. The graph keeps what a frame left for the next, and says whether it is there.
//!
//! `cargo run -p shadowgraph-examples --example temporal` writes out/temporal_1.png and out/temporal_64.png.

use shadowgraph::Gpu;
use shadowgraph::core::{Format, FullscreenShader, Graph, Part, Resize, TextureDesc};
use shadowgraph::options::AdapterChoice;
use shadowgraph::output::{Pixels, write_png};

const SIZE_PX: [u32; 2] = [320, 180];

/// Points in a disc's penumbra, one a frame: one frame is noise, many are soft.
const ACCUMULATE: &str = "
    @group(0) @binding(0) var before: texture_2d<f32>;
    // The frame's number, and the part of it in the mean.
    @group(0) @binding(1) var<uniform> frame: vec2f;

    fn noise(p: vec3f) -> f32 {
        return fract(sin(dot(p, vec3f(12.9898, 78.233, 37.719))) * 43758.5453);
    }

    @fragment
    fn accumulate(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
        let here = (uv - 0.5) * vec2f(16.0, 9.0) / 9.0;
        let angle = 6.2831853 * noise(vec3f(position.xy, frame.x));
        let jitter = vec2f(cos(angle), sin(angle)) * 0.12 * sqrt(noise(vec3f(position.yx, frame.x + 0.5)));
        let lit = f32(length(here + jitter) > 0.3);
        let mean = textureLoad(before, vec2u(position.xy), 0).r;
        return vec4f(mix(mean, lit, frame.y));
    }";

const SHOW: &str = "
    @group(0) @binding(0) var mean: texture_2d<f32>;

    @fragment
    fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
        return vec4f(textureLoad(mean, vec2u(position.xy), 0).rrr, 1.0);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let accumulate = FullscreenShader::wgsl("accumulate", ACCUMULATE);
    let show = FullscreenShader::wgsl("show", SHOW);
    let [width, height] = SIZE_PX;
    let mut graph = Graph::new();
    let mut frames = 0;
    for number in 1..=64u32 {
        let mut frame = graph.frame();
        let mut mean = frame.history("mean", TextureDesc::d2(width, height, Format::R32Float), Resize::Reset);
        // After a resize there is nothing before, and the mean begins anew.
        frames = if mean.valid { frames + 1 } else { 1 };
        let block: Vec<u8> =
            [number as f32, 1.0 / frames as f32].iter().flat_map(|v| v.to_le_bytes()).collect();
        let pass = frame.fullscreen("accumulate", &accumulate).sample(&mean.previous).uniform(&block[..]);
        pass.draw(&mut mean.current);
        let mut picture = frame.create_texture("picture", TextureDesc::d2(width, height, Format::Rgba8Unorm));
        frame.fullscreen("show", &show).sample(&mean.current).draw(&mut picture);
        let texels = frame.read_back_texture(&picture, Part::WHOLE);

        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
        let texels = executed.read_back(texels).ok_or("nothing was read")?;
        gpu.queue.submit([encoder.finish()]);
        if number == 1 || number == 64 {
            let file = format!("out/temporal_{number}.png");
            write_png(file.as_ref(), width, height, Pixels::Rgba, &texels.wait(&gpu.device)?)?;
        }
    }
    Ok(())
}
