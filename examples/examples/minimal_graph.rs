//! The smallest graph: one pass that clears a texture, another that draws over it, and the picture read back.
//!
//! `cargo run -p shadowgraph-examples --example minimal_graph` writes out/minimal_graph.png.

use shadowgraph::Gpu;
use shadowgraph::core::{Contents, Format, FullscreenShader, Graph, Part, TextureDesc};
use shadowgraph::options::AdapterChoice;
use shadowgraph::output::{Pixels, write_png};

const DISC: &str = "
    @fragment
    fn disc(@location(0) uv: vec2f) -> @location(0) vec4f {
        let from_middle = length((uv - 0.5) * vec2f(16.0, 9.0) / 9.0);
        if from_middle > 0.35 {
            discard;
        }
        return vec4f(1.0, 0.5 + uv.y * 0.5, 0.2, 1.0);
    }";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let disc = FullscreenShader::wgsl("disc", DISC);
    let mut graph = Graph::new();

    let mut frame = graph.frame();
    let mut picture = frame.create_texture("picture", TextureDesc::d2(320, 180, Format::Rgba8UnormSrgb));
    frame.render_pass("clear").color(&mut picture, Contents::clear_color([0.05, 0.1, 0.2, 1.0]));
    frame.fullscreen("disc", &disc).draw_over(&mut picture, None);
    let texels = frame.read_back_texture(&picture, Part::WHOLE);

    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
    let texels = executed.read_back(texels).ok_or("nothing was read")?;
    gpu.queue.submit([encoder.finish()]);
    let bytes = texels.wait(&gpu.device)?;
    Ok(write_png("out/minimal_graph.png".as_ref(), 320, 180, Pixels::Rgba, &bytes)?)
}
