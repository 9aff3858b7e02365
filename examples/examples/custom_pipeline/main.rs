//! A pipeline of one's own, as a file and as a script, with a node of one's own in it: both give the same plan and pictures.
//!
//! `cargo run -p shadowgraph-examples --example custom_pipeline` writes out/custom_pipeline.png as the file draws it, and
//! `-- script` as the script does; with `--window` too it is a window.
#![allow(clippy::print_stdout, reason = "an example is a program")]

mod script;
mod vignette;

use script::Script;
use shadowgraph::options::Aov;
use shadowgraph::pipelines::{Parameters, Pipeline};
use shadowgraph::scene::demo::demo_scene;
use shadowgraph::shadows::EVSM;
use shadowgraph::{Gpu, Registry, RenderConfig, Renderer, ViewOptions};
use shadowgraph_examples::{Canvas, Example, Failure, main_of};
use std::process::ExitCode;
use vignette::Vignette;

struct Mine {
    /// The one that is seen comes last.
    renderers: [Renderer; 2],
    options: ViewOptions,
}

impl Example for Mine {
    const NAME: &'static str = "custom_pipeline";
    const WORD: &'static str = "`file` or `script`";
    // Pixels look at another place in each frame, so edges are smooth after some.
    const FRAMES: u32 = 8;

    fn new(gpu: &Gpu, word: Option<&str>) -> Result<Self, Failure> {
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
        match word {
            None | Some("file") => {}
            Some("script") => renderers.reverse(),
            Some(other) => return Err(format!("`{other}`: it is `file` or `script`").into()),
        }
        Ok(Self { renderers, options })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, number }: Canvas<'_>) -> Result<(), Failure> {
        let [first, last] = &mut self.renderers;
        let first = first.record(gpu, encoder, target, &self.options)?;
        let last = last.record(gpu, encoder, target, &self.options)?;
        println!("frame {number}: the plans are equal: {}", first.plan() == last.plan());
        Ok(())
    }
}

fn main() -> ExitCode {
    main_of::<Mine>()
}
