//! Coloured shadows: a window of stained glass, drawn with the technique that is named, or `pcf`.
//!
//! `cargo run -p shadowgraph-examples --example stained_glass -- raytraced`
#![allow(clippy::print_stdout, reason = "an example is a program")]

use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::scene::trials::stained_glass;
use shadowgraph::shadows::{ShadowSettings, Techniques};
use shadowgraph::{Gpu, Renderer, ViewOptions};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "pcf".into());
    let technique = Techniques::built_in().find(&name)?;
    let scene = stained_glass();
    let camera = scene.cameras[0].clone();
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let options = ViewOptions { camera, size_px: [960, 540], shadows: ShadowSettings::default() };
    let mut renderer = Renderer::with(&gpu, scene, &options.camera, Aov::Color, technique)?;
    let picture = renderer.draw(&gpu, &options)?.picture;
    let [width, height] = options.size_px;
    let file = format!("out/stained_glass_{name}.png");
    std::fs::create_dir_all("out")?;
    image::save_buffer(&file, &picture.rgba8, width, height, image::ColorType::Rgba8)?;
    println!("wrote {file}");
    Ok(())
}
