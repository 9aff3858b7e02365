//! Contents, and what follows from them: culling, loads and stores.

use super::{check, draw, filter, hdr, plan};
use shadowgraph_core::{ClearValue, Contents, Format, Frame, Rect, Subresource};

/// A pass that nothing needs does not run, nor do passes whose results only it reads.
#[test]
fn cull() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let histogram = filter(&mut frame, "histogram", &scene);
    filter(&mut frame, "histogram overlay", &histogram);
    let mut stray = frame.compute_pass("stray");
    stray.sample(&scene);
    let image = filter(&mut frame, "tonemap", &scene);
    frame.export_texture(&image);
    check("cull", &plan(frame).to_text());
}

/// A pass whose result is overwritten before it is read does not run.
#[test]
fn overwritten() {
    let mut frame = Frame::new();
    let mut image = draw(&mut frame, "image");
    frame.render_pass("title screen").color(&mut image, Contents::Overwrite);
    frame.export_texture(&image);
    check("overwritten", &plan(frame).to_text());
}

/// The same with several passes that together overwrite everything.
#[test]
fn overwritten_in_parts() {
    let mut frame = Frame::new();
    let mut image = draw(&mut frame, "image");
    for (name, x) in [("left half", 0), ("right half", 640)] {
        let half = Subresource::FULL.rect(Rect::new(x, 0, 640, 720));
        frame.render_pass(name).subresource(half).color(&mut image, Contents::Overwrite);
    }
    frame.export_texture(&image);
    check("overwritten_in_parts", &plan(frame).to_text());
}

/// A node without its optional input reads a placeholder of one texel, cleared once.
#[test]
fn placeholder() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let occlusion = frame.when(false, |frame| hdr(frame, "occlusion"));
    let occlusion = frame.or_placeholder(occlusion.as_ref(), Format::R8Unorm, ClearValue::Color([1.0; 4]));
    let mut image = hdr(&mut frame, "image");
    let mut pass = frame.render_pass("light");
    pass.sample(&scene);
    pass.sample(&occlusion);
    pass.color(&mut image, Contents::Overwrite);
    frame.export_texture(&image);
    check("placeholder", &plan(frame).to_text());
}
