//! A day: the sun moves, and each of its positions is a PNG. Shadows lengthen, and exposure follows the light.
//!
//! `cargo run -p shadowgraph-examples --example day_cycle` writes out/day_cycle/00.png to 23.png; `-- --window` repeats
//! it.

use glam::{DVec3, Vec3};
use shadowgraph::options::Aov;
use shadowgraph::scene::{Light, LightKey, LightKind};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use shadowgraph_samples::demo::demo_scene;
use std::process::ExitCode;

/// Returns the sun at a time of the day, 0 at sunrise and 1 at sunset; a low sun is redder and weaker.
fn sun(day: f64) -> Light {
    let angle = (0.05 + 0.9 * day) * std::f64::consts::PI;
    let direction = -DVec3::new(angle.cos(), angle.sin(), 0.35).normalize();
    let height = angle.sin() as f32;
    let color = Vec3::new(1.0, 0.55 + 0.45 * height, 0.25 + 0.75 * height);
    let intensity = 100_000.0 * height.powf(1.5);
    Light {
        name: Some("sun".into()),
        kind: LightKind::Directional { direction },
        color,
        intensity,
        casts_shadow: true,
    }
}

struct Day {
    renderer: Renderer,
    options: ViewOptions,
    sun: LightKey,
}

impl Example for Day {
    const NAME: &'static str = "day_cycle";
    const SIZE_PX: [u32; 2] = [320, 180];
    const FRAMES: u32 = 24;
    const SEQUENCE: bool = true;

    fn new(gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        let scene = demo_scene();
        let sun = scene.light_keys()[0];
        let camera = scene.cameras[0].clone();
        let options = ViewOptions { camera, size_px: Self::SIZE_PX, shadows: Default::default() };
        let renderer = Renderer::new(gpu, scene, &options.camera, Aov::Color)?;
        Ok(Self { renderer, options, sun })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, number, .. }: Canvas<'_>) -> Result<(), Failure> {
        let day = f64::from(number % Self::FRAMES) / f64::from(Self::FRAMES - 1);
        self.renderer.scene_mut().replace_light(self.sun, sun(day))?;
        self.renderer.record(gpu, encoder, target, &self.options)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<Day>()
}
