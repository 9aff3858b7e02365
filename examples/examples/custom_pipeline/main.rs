//! A custom pipeline with a custom node, as a file and as a script. Both give the same plans and images.
//!
//! `cargo run -p shadowgraph-examples --example custom_pipeline` writes out/custom_pipeline.png with the file,
//! `-- script` with the script; add `--window` to open a window.
#![allow(clippy::print_stdout, reason = "an example is a program")]

mod script;
mod vignette;

use script::Script;
use shadowgraph::options::Aov;
use shadowgraph::pipelines::{Parameters, Pipeline};
use shadowgraph::shadows::EVSM;
use shadowgraph::{Gpu, Registry, RenderConfig, Renderer, ViewOptions};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use shadowgraph_samples::demo::demo_scene;
use std::process::ExitCode;
use vignette::Vignette;

struct Mine {
    /// The one whose image is kept comes last.
    renderers: [Renderer; 2],
    options: ViewOptions,
}

impl Example for Mine {
    const NAME: &'static str = "custom_pipeline";
    const ARGUMENT: &'static str = "`file` or `script`";
    // The camera is jittered, so edges are smooth after some frames.
    const FRAMES: u32 = 8;

    fn new(gpu: &Gpu, argument: Option<&str>) -> Result<Self, Failure> {
        let Registry { mut nodes, techniques } = Registry::built_in();
        nodes.register::<Vignette>()?;
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/custom_pipeline/pipeline.ron");
        let file = Pipeline::load(path.as_ref(), &nodes, &techniques, &Parameters::default())?;
        let script = Pipeline::script("script", |build| Ok(Box::new(Script::new(build)?)));
        let script = RenderConfig { technique: Some(EVSM.into()), ..RenderConfig::from(script) };
        let scene = demo_scene();
        let camera = scene.cameras[0].clone();
        let options = ViewOptions { camera, size_px: Self::SIZE_PX, shadows: Default::default() };
        let renderer = |config: RenderConfig| {
            Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Color, config)
        };
        let mut renderers = [renderer(script)?, renderer(file.into())?];
        match argument {
            None | Some("file") => {}
            Some("script") => renderers.reverse(),
            Some(other) => {
                return Err(format!("unknown argument `{other}`; expected one of: file, script").into());
            }
        }
        Ok(Self { renderers, options })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, number, .. }: Canvas<'_>) -> Result<(), Failure> {
        let [first, last] = &mut self.renderers;
        let first = first.record(gpu, encoder, target, &self.options)?;
        let last = last.record(gpu, encoder, target, &self.options)?;
        println!("frame {number}: the plans are equal: {}", first.plan() == last.plan());
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<Mine>()
}
