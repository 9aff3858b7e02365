//! Two views, an eye each: the same sub-graph declared twice, and both drawn into halves of one image. The halves do not
//! order each other, and the second view reuses the textures of the first.
//!
//! `cargo run -p shadowgraph-core --example two_views` writes `out/two_views.png` and prints the plan.
#![allow(clippy::print_stdout, missing_docs, reason = "an example is a program")]

mod common;

use shadowgraph_core::{
    Format, Frame, FullscreenShader, Graph, Rect, Subresource, Texture, TextureDesc, wgpu,
};

const SIDE: u32 = 320;

struct Shaders {
    march: FullscreenShader,
    grade: FullscreenShader,
    linear: wgpu::Sampler,
}

/// The view of one eye, as a texture.
fn see(frame: &mut Frame<'_>, shaders: &Shaders, eye_x: f32) -> Texture {
    let mut color = frame.create_texture("color", TextureDesc::d2(SIDE, SIDE, Format::Rgba16Float));
    let eye = [eye_x, 0.0, 0.0, 0.0].map(f32::to_le_bytes).concat();
    frame.fullscreen("march", &shaders.march).uniform(&eye[..]).draw(&mut color);
    color
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (device, queue) = common::open()?;
    let shaders = Shaders {
        march: FullscreenShader::wgsl("march", include_str!("two_views.wgsl")),
        grade: FullscreenShader::wgsl("grade", include_str!("two_views_grade.wgsl")),
        linear: device.create_sampler(&wgpu::SamplerDescriptor::default()),
    };
    let mut graph = Graph::new();

    let mut frame = graph.frame();
    let both = TextureDesc::d2(2 * SIDE, SIDE, Format::Rgba8UnormSrgb);
    let mut image = frame.create_texture("image", both);
    let eyes = [("left", -0.3, [1.0, 0.9, 0.85, 1.0]), ("right", 0.3, [0.85, 0.9, 1.0, 1.0f32])];
    for (index, (name, eye_x, tint)) in eyes.into_iter().enumerate() {
        // Histories declared inside would belong to this view.
        frame.view(name, |frame| {
            let color = see(frame, &shaders, eye_x);
            let half = Rect::new(index as u32 * SIDE, 0, SIDE, SIDE);
            let grade = frame.fullscreen("grade", &shaders.grade).sample(&color).sampler(&shaders.linear);
            let tint = tint.map(f32::to_le_bytes).concat();
            grade.uniform(&tint[..]).subresource(Subresource::FULL.rect(half)).draw(&mut image);
        });
    }
    let pixels = frame.read_back_texture(&image, Subresource::FULL);

    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    queue.submit([encoder.finish()]);
    print!("{}", executed.plan().to_text());
    let pixels = executed.read_back(pixels).ok_or("nothing was read back")?.wait(&device)?;
    common::save("two_views", 2 * SIDE, SIDE, &pixels)
}
