//! A post-process chain: one line for each pass. The graph derives usages, loads, stores and the sharing of textures.
//!
//! `cargo run -p shadowgraph-core --example post_process` writes `out/post_process.png` and prints the plan.
#![allow(clippy::print_stdout, missing_docs, reason = "an example is a program")]

mod common;

use shadowgraph_core::{Format, Frame, FullscreenShader, Graph, Subresource, Texture, TextureDesc, wgpu};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 360;

struct Shaders {
    points: FullscreenShader,
    bright: FullscreenShader,
    blur: FullscreenShader,
    combine: FullscreenShader,
    linear: wgpu::Sampler,
}

impl Shaders {
    fn new(device: &wgpu::Device) -> Self {
        let chain =
            |entry| FullscreenShader::wgsl(entry, include_str!("post_process.wgsl")).entry_point(entry);
        Self {
            points: chain("points"),
            bright: chain("bright"),
            blur: chain("blur"),
            combine: FullscreenShader::wgsl("combine", include_str!("post_combine.wgsl")),
            linear: device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }
}

/// A node: pixels brighter than white, at half the size, blurred along one axis after the other.
fn glow(frame: &mut Frame<'_>, shaders: &Shaders, scene: &Texture) -> Texture {
    let half = TextureDesc::d2(WIDTH / 2, HEIGHT / 2, Format::Rgba16Float);
    frame.node("glow", |frame| {
        let mut glow = frame.create_texture("bright", half);
        frame.fullscreen("bright", &shaders.bright).sample(scene).sampler(&shaders.linear).draw(&mut glow);
        for (name, step) in [("across", [2.0 / WIDTH as f32, 0.0]), ("down", [0.0, 2.0 / HEIGHT as f32])] {
            let mut blurred = frame.create_texture(name, half);
            let step = step.map(f32::to_le_bytes).concat();
            let pass = frame.fullscreen(name, &shaders.blur).sample(&glow);
            pass.sampler(&shaders.linear).uniform(&step[..]).draw(&mut blurred);
            glow = blurred;
        }
        glow
    })
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (device, queue) = common::open()?;
    let shaders = Shaders::new(&device);
    let mut graph = Graph::new();

    let mut frame = graph.frame();
    let mut scene = frame.create_texture("scene", TextureDesc::d2(WIDTH, HEIGHT, Format::Rgba16Float));
    let mut image = frame.create_texture("image", TextureDesc::d2(WIDTH, HEIGHT, Format::Rgba8UnormSrgb));
    frame.fullscreen("points", &shaders.points).draw(&mut scene);
    let glow = glow(&mut frame, &shaders, &scene);
    let combine = frame.fullscreen("combine", &shaders.combine);
    combine.sample(&scene).sample(&glow).sampler(&shaders.linear).draw(&mut image);
    let pixels = frame.read_back_texture(&image, Subresource::FULL);

    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    queue.submit([encoder.finish()]);
    print!("{}", executed.plan().to_text());
    let pixels = executed.read_back(pixels).ok_or("nothing was read back")?.wait(&device)?;
    common::save("post_process", WIDTH, HEIGHT, &pixels)
}
