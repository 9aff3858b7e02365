//! Aliasing of resources in a physical texture.

use super::{BLACK, check, depth, draw, filter, hdr, plan};
use shadowgraph_core::{Contents, Format, Frame, TextureDesc};

/// Resources with the same description share a texture if their lifetimes do not overlap.
#[test]
fn reuse() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let image = frame.node("post", |frame| {
        let across = filter(frame, "blur across", &scene);
        let down = filter(frame, "blur down", &across);
        filter(frame, "tonemap", &down)
    });
    frame.export_texture(&image);
    check("reuse", &plan(frame).to_text());
}

/// A storage texture does not share with attachments: storage usage can disable the compression of an attachment.
#[test]
fn storage_apart() {
    let mut frame = Frame::new();
    let scene = draw(&mut frame, "scene");
    let smooth = filter(&mut frame, "smooth", &scene);
    let mut sharp = hdr(&mut frame, "sharp");
    let mut pass = frame.compute_pass("sharpen");
    pass.sample(&smooth);
    pass.storage_texture_mut(&mut sharp, Contents::Overwrite);
    frame.export_texture(&sharp);
    check("storage_apart", &plan(frame).to_text());
}

/// The ready pass that frees memory runs first: one branch is finished before the other begins.
#[test]
fn order_chosen_for_memory() {
    let mut frame = Frame::new();
    let large = TextureDesc::d2(2560, 1440, Format::Rgba16Float);
    let mut branches =
        ["left", "right"].map(|side| frame.create_texture(format_args!("{side} large"), large));
    for (side, large) in ["left", "right"].into_iter().zip(&mut branches) {
        frame.render_pass(format_args!("draw {side}")).color(large, BLACK);
    }
    let small = [(0, "left"), (1, "right")].map(|(index, side)| filter(&mut frame, side, &branches[index]));
    let mut image = hdr(&mut frame, "image");
    let mut join = frame.render_pass("join");
    for side in &small {
        join.sample(side);
    }
    join.color(&mut image, Contents::Overwrite);
    frame.export_texture(&image);
    check("order_chosen_for_memory", &plan(frame).to_text());
}

/// A depth buffer that two merged passes share is transient too: they are one render pass.
#[test]
fn transient_across_merged_passes() {
    let mut frame = Frame::new();
    let mut image = hdr(&mut frame, "image");
    let mut depth = depth(&mut frame, "depth");
    let mut opaque = frame.render_pass("opaque");
    opaque.color(&mut image, BLACK);
    opaque.depth(&mut depth, super::FAR);
    let mut glass = frame.render_pass("glass");
    glass.color(&mut image, Contents::Preserve);
    glass.depth(&mut depth, Contents::Preserve);
    frame.export_texture(&image);
    check("transient_across_merged_passes", &plan(frame).to_text());
}
