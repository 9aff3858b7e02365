//! A thousand point lights. With the pipeline `forward_plus` each pixel visits only the lights near it, and the image is equal to the bit
//! to that of `minimal_lit`, which visits all.
//!
//! `cargo run -p shadowgraph-examples --example many_lights` writes out/many_lights.png and prints the GPU time of the
//! lighting of an image of half its width and height; `-- minimal_lit` draws with that pipeline, and `-- --window` opens a window.
#![allow(clippy::print_stdout, reason = "an example is a program")]

use glam::{DVec3, Vec3};
use shadowgraph::core::{PassTime, Timer};
use shadowgraph::options::Aov;
use shadowgraph::pipelines::Parameters;
use shadowgraph::scene::{Light, LightKind};
use shadowgraph::{Gpu, Pipeline, RenderConfig, Renderer, ViewOptions};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use shadowgraph_samples::demo::demo_scene;
use std::process::ExitCode;

const LIGHT_COUNT: u32 = 1_000;

/// Returns a light above the ground with its own colour; the lights are distributed by the golden angle.
fn point_light(number: u32) -> Light {
    let angle = f64::from(number) * 2.399_963;
    let radius = 22.0 * (f64::from(number) / f64::from(LIGHT_COUNT)).sqrt();
    let position_world = DVec3::new(angle.cos() * radius, 0.5 + f64::from(number % 3), angle.sin() * radius);
    let hue = number as f32 * 0.7;
    let color = Vec3::new(hue.sin(), (hue + 2.1).sin(), (hue + 4.2).sin()) * 0.5 + 0.5;
    let kind = LightKind::Point { position_world, range: Some(2.5) };
    Light { name: None, kind, color, intensity: 12.0, casts_shadow: false }
}

struct ManyLights {
    renderer: Renderer,
    options: ViewOptions,
}

impl Example for ManyLights {
    const NAME: &'static str = "many_lights";
    const ARGUMENT: &'static str = "a pipeline's name";
    const SIZE_PX: [u32; 2] = [320, 180];

    fn new(gpu: &Gpu, argument: Option<&str>) -> Result<Self, Failure> {
        let mut scene = demo_scene();
        let moon = Light { intensity: 0.6, ..scene.lights()[0].clone() };
        scene.set_lights(std::iter::once(moon).chain((0..LIGHT_COUNT).map(point_light)));
        let camera = scene.cameras[0].clone();
        let options = ViewOptions { camera, size_px: Self::SIZE_PX, shadows: Default::default() };
        let name = argument.unwrap_or("forward_plus");
        let config = RenderConfig::from(Pipeline::built_in(name, &Parameters::default())?);
        let mut renderer = Renderer::with_config(gpu, scene, &options.camera, Aov::Color, config)?;
        // Drivers may compile shaders at the first draw; a small one is enough for that.
        renderer.draw(gpu, &ViewOptions { size_px: [16, 9], ..options.clone() })?;
        let half = ViewOptions { size_px: Self::SIZE_PX.map(|size| size / 2), ..options.clone() };
        let drawn = renderer.draw_timed(gpu, &half, Some(&mut Timer::new()))?;
        let lighting = drawn.times.iter().filter(|time| !time.pass.starts_with("shadows/"));
        let milliseconds: Option<f64> = lighting.map(PassTime::gpu_share_ms).sum();
        println!("{name}: {:.1} ms", milliseconds.unwrap_or(f64::NAN));
        Ok(Self { renderer, options })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, .. }: Canvas<'_>) -> Result<(), Failure> {
        self.renderer.record(gpu, encoder, target, &self.options)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<ManyLights>()
}
