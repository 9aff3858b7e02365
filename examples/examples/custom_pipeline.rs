//! A pipeline of one's own, as a file and as a script, with a node of one's own in it: both give the same plan and pictures.
//!
//! `cargo run -p shadowgraph-examples --example custom_pipeline` writes out/custom_pipeline.png.

#![allow(clippy::print_stdout, reason = "an example is a program")]

use shadowgraph::core::{Format, Frame, FullscreenShader, Texture};
use shadowgraph::lighting::post::{Bloom, Jitters, Occlusion, OcclusionSettings, Sky, SkySettings, Temporal};
use shadowgraph::lighting::{Forward, Tonemap};
use shadowgraph::nodes::{Allows, GeometryNode, Node, Port, Ports, Setting, Settings};
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::pipelines::{Build, Choices, Output, Pipeline, View, Wiring};
use shadowgraph::scene::demo::demo_scene;
use shadowgraph::shadows::EVSM;
use shadowgraph::{Error, Gpu, Method, Registry, Renderer, ViewOptions};

/// A node: darkens the corners of the picture.
struct Vignette {
    shader: FullscreenShader,
    strength: f32,
}

impl Node for Vignette {
    const NAME: &'static str = "vignette";
    const ABOUT: &'static str = "darkens the corners of the picture";
    const INPUTS: &'static [Port] = &[Port::texture("light", "what is lit")];
    const OUTPUTS: &'static [Port] = &[Port::texture("light", "the same, darker in the corners")];
    const SETTINGS: &'static [Setting] =
        &[Setting::new("strength", Allows::Number(0.5, 0.0, 1.0), "how dark corners are")];

    fn new(_build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        let shader = FullscreenShader::wgsl("vignette", include_str!("custom_pipeline.wgsl"));
        Ok(Self { shader, strength: settings.number("strength")? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut darker = ports.create("light", frame, view.texture_desc(Format::Rgba16Float));
        self.draw(frame, &ports.texture("light")?, &mut darker);
        ports.set("light", darker);
        Ok(())
    }
}

impl Vignette {
    fn draw(&self, frame: &mut Frame<'_>, light: &Texture, darker: &mut Texture) {
        let pass = frame.fullscreen("vignette", &self.shader).sample(light);
        pass.uniform(&self.strength.to_le_bytes()).draw(darker);
    }
}

/// The pipeline as a script: what it keeps from frame to frame, and one call per step.
struct Script {
    jitters: Jitters,
    geometry: GeometryNode,
    occlusion: Occlusion,
    lighting: Forward,
    sky: Sky,
    temporal: Temporal,
    bloom: Bloom,
    vignette: Vignette,
    tonemap: Tonemap,
}

impl Script {
    fn new(build: &Build<'_>) -> Result<Self, Error> {
        let shader = FullscreenShader::wgsl("vignette", include_str!("custom_pipeline.wgsl"));
        Ok(Self {
            jitters: Jitters::default(),
            geometry: GeometryNode::new(build)?,
            occlusion: Occlusion::new(build.device)?,
            lighting: Forward::new(build.device, build.layouts, build.technique, build.lit)?,
            sky: Sky::new(build.device)?,
            temporal: Temporal::new(build.device)?,
            bloom: Bloom::new(build.device)?,
            vignette: Vignette { shader, strength: 0.6 },
            tonemap: Tonemap::new(build.device)?,
        })
    }
}

impl Wiring for Script {
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error> {
        let (geometry, camera) = (view.geometry(), (view.number, &view.options.camera));
        let light =
            |frame: &mut Frame<'f>| frame.create_texture("light", view.texture_desc(Format::Rgba16Float));

        let buffers = view.records().shifted(self.jitters.next(view.number)).upload(frame);
        let (depth, screen) = frame.node("geometry", |frame| self.geometry.add_to(frame, view, &buffers))?;
        let shadows = view.shadows(frame, screen.as_ref())?;
        let occluded = frame.node("occlusion", |frame| {
            self.occlusion.add_to(frame, &buffers, &depth, &OcclusionSettings::default())
        });
        let mut lit = frame.node("lighting", |frame| {
            self.lighting.lit(frame, &occluded, &shadows, &depth, geometry, view.background())
        })?;
        frame
            .node("sky", |frame| self.sky.add_to(frame, &buffers, &depth, &mut lit, &SkySettings::default()));
        let steady = frame
            .node("temporal", |frame| self.temporal.add_to(frame, [&lit, &depth], camera, &buffers, 0.1));
        let bloomed = frame.node("bloom", |frame| {
            let mut target = light(frame);
            self.bloom.add_to(frame, &steady, &mut target, 0.06, 6);
            target
        });
        let darker = frame.node("vignette", |frame| {
            let mut target = light(frame);
            self.vignette.draw(frame, &bloomed, &mut target);
            target
        });
        let picture = view.tonemapped(frame, &self.tonemap, &darker);
        Ok(Output { picture, light: Some(lit), depth: Some(depth), view: Some(buffers), shadows })
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut registry = Registry::built_in();
    registry.nodes.register::<Vignette>()?;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/custom_pipeline.ron");
    let file = Pipeline::load(path.as_ref(), &registry.nodes, &registry.techniques, &Choices::default())?;
    let script = Pipeline::script("script", |build| Ok(Box::new(Script::new(build)?)));

    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let (scene, size_px) = (demo_scene(), [640, 360]);
    let options = ViewOptions { camera: scene.cameras[0].clone(), size_px, shadows: Default::default() };
    let renderer = |method: Method| Renderer::with(&gpu, scene.clone(), &options.camera, Aov::Color, method);
    let mut of_file = renderer(file.into())?;
    let mut of_script = renderer(Method { technique: Some(EVSM.into()), ..Method::from(script) })?;
    // Pixels look at another place in each frame, so edges are smooth after some.
    for frame in 0..8 {
        let (a, b) = (of_file.draw(&gpu, &options)?, of_script.draw(&gpu, &options)?);
        let same = (a.plan == b.plan, a.picture == b.picture);
        println!("frame {frame}: equal plans {}, equal pictures {}", same.0, same.1);
        let (file, [width, height]) = ("out/custom_pipeline.png".as_ref(), size_px);
        write_png(file, width, height, Pixels::Rgba, &a.picture.rgba8)?;
    }
    Ok(())
}
