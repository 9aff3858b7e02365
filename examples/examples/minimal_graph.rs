//! The smallest graph: one pass that clears a texture, and one that draws over it.
//!
//! `cargo run -p shadowgraph-examples --example minimal_graph` writes out/minimal_graph.png, and with `-- --window` it is a window.

use shadowgraph::Gpu;
use shadowgraph::core::{Contents, FullscreenShader, Graph};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use std::process::ExitCode;

const DISC: &str = "
    @fragment
    fn disc(@location(0) uv: vec2f) -> @location(0) vec4f {
        let from_middle = length((uv - 0.5) * vec2f(16.0, 9.0) / 9.0);
        if from_middle > 0.35 {
            discard;
        }
        return vec4f(1.0, 0.5 + uv.y * 0.5, 0.2, 1.0);
    }";

struct Disc {
    graph: Graph,
    shader: FullscreenShader,
}

impl Example for Disc {
    const NAME: &'static str = "minimal_graph";
    const SIZE_PX: [u32; 2] = [320, 180];

    fn new(_gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        Ok(Self { graph: Graph::new(), shader: FullscreenShader::wgsl("disc", DISC) })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, .. }: Canvas<'_>) -> Result<(), Failure> {
        let mut frame = self.graph.frame();
        let mut image = frame.import_texture("image", target, false);
        frame.render_pass("clear").color(&mut image, Contents::clear_color([0.05, 0.1, 0.2, 1.0]));
        frame.fullscreen("disc", &self.shader).draw_over(&mut image, None);
        self.graph.compile(frame)?.execute(&mut self.graph, &gpu.device, encoder)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<Disc>()
}
