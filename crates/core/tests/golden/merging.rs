//! Merging of passes into a render pass, and what prevents it.

use super::{BLACK, FAR, check, depth, filter, hdr, plan};
use shadowgraph_core::{BufferDesc, Contents, Frame, Options};

/// Adjacent passes with the same attachments become one render pass: one load, one store.
#[test]
fn merge() {
    let mut frame = Frame::new();
    let (mut scene, mut depth) = (hdr(&mut frame, "scene"), depth(&mut frame, "depth"));
    frame.node("scene", |frame| {
        for (name, first) in [("sky", true), ("opaque", false), ("glass", false)] {
            let mut pass = frame.render_pass(name);
            pass.color(&mut scene, if first { BLACK } else { Contents::Preserve });
            pass.depth(&mut depth, if first { FAR } else { Contents::Preserve });
        }
    });
    let picture = frame.node("post", |frame| filter(frame, "tonemap", &scene));
    frame.export_texture(&picture);
    let plan = plan(frame);
    let why = plan.explain_pass(plan.find_pass("opaque").unwrap());
    check("merge", &format!("{}\n{why}", plan.to_text()));
}

/// A pass that reads what the render pass writes must wait for its end.
#[test]
fn refused_merge_reads() {
    let mut frame = Frame::new();
    let mut scene = hdr(&mut frame, "scene");
    let mut hits = frame.create_buffer("hits", BufferDesc::new(1_024));
    let mut pass = frame.render_pass("count hits");
    pass.color(&mut scene, BLACK);
    pass.storage_buffer_mut(&mut hits, Contents::Overwrite);
    let mut pass = frame.render_pass("draw hits");
    pass.color(&mut scene, Contents::Preserve);
    pass.storage_buffer(&hits);
    frame.export_texture(&scene);
    check("refused_merge_reads", &plan(frame).to_text());
}

/// A pass that clears an attachment starts a render pass, since the clear is free there: here a cockpit that is
/// drawn over the world with a depth buffer cleared for it.
#[test]
fn refused_merge_clears() {
    let mut frame = Frame::new();
    let (mut scene, mut depth) = (hdr(&mut frame, "scene"), depth(&mut frame, "depth"));
    for (name, contents) in [("world", BLACK), ("cockpit", Contents::Preserve)] {
        let mut pass = frame.render_pass(name);
        pass.color(&mut scene, contents);
        pass.depth(&mut depth, FAR);
    }
    frame.export_texture(&scene);
    check("refused_merge_clears", &plan(frame).to_text());
}

/// Passes whose attachments differ by at least one need separate render passes.
#[test]
fn refused_merge_attachments() {
    let mut frame = Frame::new();
    let (mut scene, mut depth) = (hdr(&mut frame, "scene"), depth(&mut frame, "depth"));
    frame.render_pass("depth first").depth(&mut depth, FAR);
    let mut pass = frame.render_pass("opaque");
    pass.depth(&mut depth, Contents::Preserve);
    pass.color(&mut scene, BLACK);
    let mut pass = frame.render_pass("decals");
    pass.depth_read(&depth);
    pass.color(&mut scene, Contents::Preserve);
    frame.export_texture(&scene);
    check("refused_merge_attachments", &plan(frame).to_text());
}

/// The frame can disable merging, for instance to time each pass alone.
#[test]
fn merging_off() {
    let mut frame = Frame::new();
    frame.set_options(Options { merge: false, transient_attachments: false, ..Options::default() });
    let mut scene = hdr(&mut frame, "scene");
    frame.render_pass("sky").color(&mut scene, BLACK);
    frame.render_pass("ground").color(&mut scene, Contents::Preserve);
    frame.export_texture(&scene);
    let plan = plan(frame);
    let why = plan.explain_pass(plan.find_pass("ground").unwrap());
    check("merging_off", &format!("{}\n{why}", plan.to_text()));
}
