//! A day: the sun goes its way, and each of its places is a PNG. Shadows lengthen, and exposure follows the light.
//!
//! `cargo run -p shadowgraph-examples --example day_cycle -- 24` writes out/day_cycle/00.png to 23.png.

use glam::{DVec3, Vec3};
use indicatif::ProgressBar;
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::scene::demo::demo_scene;
use shadowgraph::scene::{Light, LightKind};
use shadowgraph::{Gpu, Renderer, ViewOptions};

/// The sun at a part of the day, 0 at its rise and 1 at its set: lower is redder and weaker.
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: u32 = std::env::args().nth(1).map_or(Ok(24), |count| count.parse())?;
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let scene = demo_scene();
    let lamps = scene.lights[1..].to_vec();
    let size_px = [320, 180];
    let options = ViewOptions { camera: scene.cameras[0].clone(), size_px, shadows: Default::default() };
    let mut renderer = Renderer::new(&gpu, scene, &options.camera, Aov::Color)?;
    let progress = ProgressBar::new(count.into());
    for number in 0..count {
        let day = f64::from(number) / f64::from(count.max(2) - 1);
        renderer.set_lights(std::iter::once(sun(day)).chain(lamps.clone()).collect())?;
        let picture = renderer.draw(&gpu, &options)?.picture;
        let file = format!("out/day_cycle/{number:02}.png");
        write_png(file.as_ref(), size_px[0], size_px[1], Pixels::Rgba, &picture.rgba8)?;
        progress.inc(1);
    }
    progress.finish();
    Ok(())
}
