//! Temporal accumulation: a history carries the mean of all frames so far from one frame to the next.
//!
//! `cargo run -p shadowgraph-core --example accumulation` draws 64 frames and writes `out/accumulation.png`: one noisy
//! frame on the left, their mean on the right.
#![allow(clippy::print_stdout, missing_docs, reason = "an example is a program")]

mod common;

use shadowgraph_core::{
    Format, Frame, FullscreenShader, Graph, Resize, Subresource, Texture, TextureDesc, wgpu,
};

const SIDE: u32 = 320;
const FRAMES: u32 = 64;

struct Shaders {
    noisy: FullscreenShader,
    mean: FullscreenShader,
    side_by_side: FullscreenShader,
}

impl Shaders {
    fn new() -> Self {
        let mean =
            |entry| FullscreenShader::wgsl(entry, include_str!("accumulation_mean.wgsl")).entry_point(entry);
        Self {
            noisy: FullscreenShader::wgsl("noisy", include_str!("accumulation.wgsl")),
            mean: mean("mean"),
            side_by_side: mean("side_by_side"),
        }
    }
}

/// A uniform block of four numbers, the first of them `number`.
fn block(number: u32) -> Vec<u8> {
    [number, 0, 0, 0].map(u32::to_le_bytes).concat()
}

/// Returns the image of this frame, and the mean of it and all earlier frames.
fn accumulate(frame: &mut Frame<'_>, shaders: &Shaders, index: u32) -> (Texture, Texture) {
    let mut noisy = frame.create_texture("noisy", TextureDesc::d2(SIDE, SIDE, Format::Rgba16Float));
    frame.fullscreen("noisy", &shaders.noisy).uniform(&block(index)[..]).draw(&mut noisy);

    // The graph keeps both textures and swaps them. In the first frame there is no earlier mean.
    let mut mean = frame.history("mean", TextureDesc::d2(SIDE, SIDE, Format::Rgba32Float), Resize::Reset);
    let frames_before = if mean.valid { index } else { 0 };
    let pass = frame.fullscreen("mean", &shaders.mean).sample(&noisy).sample(&mean.previous);
    pass.uniform(&block(frames_before)[..]).draw(&mut mean.current);
    (noisy, mean.current)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (device, queue) = common::open()?;
    let shaders = Shaders::new();
    let mut graph = Graph::new();
    for index in 0..FRAMES {
        let mut frame = graph.frame();
        let (noisy, mean) = accumulate(&mut frame, &shaders, index);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        if index + 1 < FRAMES {
            graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
            queue.submit([encoder.finish()]);
            continue;
        }
        let both = TextureDesc::d2(2 * SIDE, SIDE, Format::Rgba8UnormSrgb);
        let mut image = frame.create_texture("image", both);
        frame.fullscreen("side by side", &shaders.side_by_side).sample(&noisy).sample(&mean).draw(&mut image);
        let pixels = frame.read_back_texture(&image, Subresource::FULL);
        let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
        queue.submit([encoder.finish()]);
        let pixels = executed.read_back(pixels).ok_or("nothing was read back")?.wait(&device)?;
        common::save("accumulation", 2 * SIDE, SIDE, &pixels)?;
    }
    println!("plans: {:?}", graph.plan_counts());
    Ok(())
}
