//! Contents, and what follows from them: culling, loads and stores.

use super::{BLACK, check, draw, filter, hdr, plan};
use shadowgraph_core::TextureUsages;
use shadowgraph_core::{
    BufferDesc, ClearValue, Contents, Format, Frame, Rect, Resize, Subresource, TextureDesc,
};

/// A pass that nothing needs does not run, nor do passes whose results only it reads.
#[test]
fn cull() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let histogram = filter(&mut frame, "histogram", &scene);
    filter(&mut frame, "histogram overlay", &histogram);
    let mut stray = frame.compute_pass("stray");
    stray.sample(&scene);
    let picture = filter(&mut frame, "tonemap", &scene);
    frame.export_texture(&picture);
    check("cull", &plan(frame).to_text());
}

/// A pass whose result is overwritten before it is read does not run.
#[test]
fn overwritten() {
    let mut frame = Frame::new();
    let mut picture = draw(&mut frame, "picture");
    frame.render_pass("title screen").color(&mut picture, Contents::Overwrite);
    frame.export_texture(&picture);
    check("overwritten", &plan(frame).to_text());
}

/// The same with several passes that together overwrite everything.
#[test]
fn overwritten_in_parts() {
    let mut frame = Frame::new();
    let mut picture = draw(&mut frame, "picture");
    for (name, x) in [("left half", 0), ("right half", 640)] {
        let half = Subresource::FULL.rect(Rect::new(x, 0, 640, 720));
        frame.render_pass(name).subresource(half).color(&mut picture, Contents::Overwrite);
    }
    frame.export_texture(&picture);
    check("overwritten_in_parts", &plan(frame).to_text());
}

/// An import is needed after the frame, so passes that write it run, and its earlier contents are loaded.
#[test]
fn import_kept() {
    let mut frame = Frame::new();
    let usage = TextureUsages::RENDER_ATTACHMENT;
    let window = TextureDesc::d2(1280, 720, Format::Bgra8UnormSrgb);
    let mut window = frame.declare_import_texture("window", window, usage, true);
    frame.render_pass("overlay").color(&mut window, Contents::Preserve);
    let plan = plan(frame);
    let why = plan.explain_resource(window.id());
    check("import_kept", &format!("{}\n{why}", plan.to_text()));
}

/// A history is read with the contents from the previous frame and written for the next; its writer always runs.
#[test]
fn history() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let mut colour = frame.history("colour", TextureDesc::d2(1280, 720, Format::Rgba16Float), Resize::Reset);
    let mut pass = frame.render_pass("accumulate");
    pass.sample(&scene);
    pass.sample(&colour.previous);
    pass.color(&mut colour.current, Contents::Overwrite);
    let plan = plan(frame);
    let why = [colour.previous.id(), colour.current.id()].map(|id| plan.explain_resource(id)).join("\n");
    check("history", &format!("{}\n{why}", plan.to_text()));
}

/// A node without its optional input reads a placeholder of one texel, cleared once.
#[test]
fn placeholder() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let occlusion = frame.when(false, |frame| hdr(frame, "occlusion"));
    let occlusion = frame.or_placeholder(occlusion.as_ref(), Format::R8Unorm, ClearValue::Color([1.0; 4]));
    let mut picture = hdr(&mut frame, "picture");
    let mut pass = frame.render_pass("light");
    pass.sample(&scene);
    pass.sample(&occlusion);
    pass.color(&mut picture, Contents::Overwrite);
    frame.export_texture(&picture);
    check("placeholder", &plan(frame).to_text());
}

/// Copy passes upload bytes from the CPU; like other passes they run only if something reads the result.
#[test]
fn uploads() {
    let mut frame = Frame::new();
    let spheres = frame.upload_buffer("spheres", vec![0; 3_000]);
    frame.upload_buffer("unused", vec![0; 16]);
    let mut visible = frame.create_buffer("visible", BufferDesc::new(400));
    let mut picture = hdr(&mut frame, "picture");
    let mut cull = frame.compute_pass("cull spheres");
    cull.storage_buffer(&spheres);
    cull.storage_buffer_mut(&mut visible, Contents::Overwrite);
    let mut pass = frame.render_pass("draw spheres");
    pass.vertex_buffer(&spheres);
    pass.indirect_buffer(&visible);
    pass.color(&mut picture, BLACK);
    frame.export_texture(&picture);
    let plan = plan(frame);
    let why = plan.explain_resource(spheres.id());
    check("uploads", &format!("{}\n{why}", plan.to_text()));
}
