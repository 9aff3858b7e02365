//! A thousand lamps. With the pipeline `forward_plus` each pixel asks only those that reach its part of the view, and the picture is the
//! same to the bit as with `forward`, which asks them all.
//!
//! `cargo run -p shadowgraph-examples --example many_lights` writes out/many_lights.png and tells how long both took on the GPU.

#![allow(clippy::print_stdout, reason = "an example is a program")]

use glam::{DVec3, Vec3};
use shadowgraph::core::{PassTime, Timer};
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::scene::demo::demo_scene;
use shadowgraph::scene::{Light, LightKind};
use shadowgraph::{Gpu, Method, Pipeline, Renderer, ViewOptions};

const LAMPS: u32 = 1_000;

/// A lamp somewhere above the ground, in some colour: spread by the golden angle.
fn lamp(number: u32) -> Light {
    let turn = f64::from(number) * 2.399_963;
    let from_middle = 22.0 * (f64::from(number) / f64::from(LAMPS)).sqrt();
    let position_world =
        DVec3::new(turn.cos() * from_middle, 0.5 + f64::from(number % 3), turn.sin() * from_middle);
    let hue = number as f32 * 0.7;
    let color = Vec3::new(hue.sin(), (hue + 2.1).sin(), (hue + 4.2).sin()) * 0.5 + 0.5;
    let kind = LightKind::Point { position_world, range: Some(2.5) };
    Light { name: None, kind, color, intensity: 12.0, casts_shadow: false }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let mut scene = demo_scene();
    // Moonlight.
    scene.lights.truncate(1);
    scene.lights[0].intensity = 0.6;
    scene.lights.extend((0..LAMPS).map(lamp));
    let size_px = [320, 180];
    let options = ViewOptions { camera: scene.cameras[0].clone(), size_px, shadows: Default::default() };

    let mut pictures = Vec::new();
    for pipeline in [Pipeline::forward(), Pipeline::forward_plus()] {
        let name = pipeline.name().to_owned();
        let mut renderer =
            Renderer::with(&gpu, scene.clone(), &options.camera, Aov::Color, Method::from(pipeline))?;
        // A driver may compile shaders at the first draw.
        renderer.draw(&gpu, &options)?;
        let drawn = renderer.draw_timed(&gpu, &options, Some(&mut Timer::new()))?;
        let lighting = drawn.times.iter().filter(|time| !time.pass.starts_with("shadows/"));
        let milliseconds: Option<f64> = lighting.map(PassTime::gpu_share_ms).sum();
        println!("{name}: {:.1} ms", milliseconds.unwrap_or(f64::NAN));
        pictures.push(drawn.picture);
    }
    println!("the pictures are equal: {}", pictures[0] == pictures[1]);
    let [width, height] = size_px;
    Ok(write_png("out/many_lights.png".as_ref(), width, height, Pixels::Rgba, &pictures[1].rgba8)?)
}
