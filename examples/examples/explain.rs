//! A frame with errors, and how the graph explains them: a culled pass, two passes that do not merge, an order.
//!
//! `cargo run -p shadowgraph-examples --example explain` prints it, and writes out/explain.html. It needs no GPU.

#![allow(clippy::print_stdout, reason = "an example is a program")]

use shadowgraph::core::{Contents, Format, Frame, TextureDesc};
use shadowgraph::inspect::{explain, explain_order, to_html};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut frame = Frame::new();
    let texture = |frame: &mut Frame<'_>, name: &str, format| {
        frame.create_texture(name, TextureDesc::d2(640, 360, format))
    };
    let mut scene = texture(&mut frame, "scene", Format::Rgba16Float);
    let mut glow = texture(&mut frame, "glow", Format::Rgba16Float);
    let mut depth = texture(&mut frame, "depth", Format::Depth32Float);
    let mut image = texture(&mut frame, "image", Format::Rgba8UnormSrgb);

    let mut opaque = frame.render_pass("opaque");
    opaque.color(&mut scene, Contents::clear_color([0.0; 4]));
    opaque.depth(&mut depth, Contents::clear_depth(0.0));
    let mut particles = frame.render_pass("particles");
    particles.color(&mut scene, Contents::Preserve);
    // Nothing reads what this pass draws, so it is culled.
    let mut blur = frame.render_pass("blur");
    blur.sample(&scene);
    blur.color(&mut glow, Contents::Overwrite);
    let mut tonemap = frame.render_pass("tonemap");
    tonemap.sample(&scene);
    tonemap.color(&mut image, Contents::Overwrite);
    frame.export_texture(&image);

    let plan = frame.compile()?.into_plan();
    for name in ["blur", "particles", "glow"] {
        println!("{}", explain(&plan, name)?);
    }
    println!("{}", explain_order(&plan, "opaque", "tonemap")?);
    std::fs::create_dir_all("out")?;
    Ok(std::fs::write("out/explain.html", to_html(&plan))?)
}
