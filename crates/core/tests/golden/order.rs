//! Causes of an order between passes, and what is none.

use super::{BLACK, FAR, check, depth, draw, filter, hdr, plan};
use shadowgraph_core::{Contents, Format, Frame, TextureDesc, TextureUsages};

/// Read-only depth may be sampled in the same pass, needs no store, and orders no readers.
#[test]
fn read_only_depth() {
    let mut frame = Frame::new();
    let mut depth = depth(&mut frame, "depth");
    frame.render_pass("depth first").depth(&mut depth, FAR);
    let mut scene = hdr(&mut frame, "scene");
    let mut pass = frame.render_pass("soft particles");
    pass.color(&mut scene, BLACK);
    pass.depth_read(&depth);
    pass.sample(&depth);
    frame.export_texture(&scene);
    check("read_only_depth", &plan(frame).to_text());
}

/// The same node declared for each view: names distinguish them, and the second view reuses the memory of the first.
#[test]
fn two_views() {
    let mut frame = Frame::new();
    let window = TextureDesc::d2(2560, 720, Format::Bgra8UnormSrgb);
    let usage = TextureUsages::RENDER_ATTACHMENT;
    let mut window = frame.declare_import_texture("window", window, usage, false);
    for (index, side) in ["left", "right"].into_iter().enumerate() {
        frame.view(side, |frame| {
            let scene = draw(frame, "scene");
            let image = filter(frame, "bloom", &scene);
            let mut present = frame.render_pass("present");
            present.sample(&image);
            present.color(&mut window, if index == 0 { BLACK } else { Contents::Preserve });
        });
    }
    check("two_views", &plan(frame).to_text());
}

/// The same frame with its order left open: the pass in between moves away, and the other two become one.
#[test]
fn order_chosen_for_merging() {
    let mut frame = Frame::new();
    let mut scene = hdr(&mut frame, "scene");
    frame.render_pass("sky").color(&mut scene, BLACK);
    let shadow = draw(&mut frame, "shadow");
    let mut pass = frame.render_pass("ground");
    pass.color(&mut scene, Contents::Preserve);
    frame.export_texture(&scene);
    frame.export_texture(&shadow);
    check("order_chosen_for_merging", &plan(frame).to_text());
}
