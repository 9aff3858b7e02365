//! Merging of passes into a render pass, and what prevents it.

use super::{BLACK, FAR, check, depth, hdr, plan};
use shadowgraph_core::{BufferDesc, Contents, Frame};

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
