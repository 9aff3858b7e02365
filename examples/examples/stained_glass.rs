//! Coloured shadows: a window of stained glass, drawn with the named technique, or `pcf`.
//!
//! `cargo run -p shadowgraph-examples --example stained_glass -- raytraced` writes out/stained_glass.png; add `--window` to
//! open a window.

use shadowgraph::options::Aov;
use shadowgraph::shadows::Techniques;
use shadowgraph::{Gpu, Pipeline, RenderConfig, Renderer, ViewOptions};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use shadowgraph_samples::test_scenes::stained_glass;
use std::process::ExitCode;

struct StainedGlass {
    renderer: Renderer,
    options: ViewOptions,
}

impl Example for StainedGlass {
    const NAME: &'static str = "stained_glass";
    const ARGUMENT: &'static str = "a technique's name";
    const SIZE_PX: [u32; 2] = [960, 540];

    fn new(gpu: &Gpu, argument: Option<&str>) -> Result<Self, Failure> {
        let technique = Techniques::built_in().find(argument.unwrap_or("pcf"))?;
        let scene = stained_glass();
        let camera = scene.cameras[0].clone();
        let options = ViewOptions { camera, size_px: Self::SIZE_PX, shadows: Default::default() };
        // The pipeline without a sky, whose light would fade the colours.
        let config = RenderConfig { pipeline: Pipeline::minimal_lit(), ..RenderConfig::from(technique) };
        let renderer = Renderer::with_config(gpu, scene, &options.camera, Aov::Color, config)?;
        Ok(Self { renderer, options })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, .. }: Canvas<'_>) -> Result<(), Failure> {
        self.renderer.record(gpu, encoder, target, &self.options)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<StainedGlass>()
}
