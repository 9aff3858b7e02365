//! Merging of passes into a render pass, and each reason against it.

use super::helpers::{BLACK, FAR, color, depth, draw, ops, pass, plan, quarter, steps};
use crate::{
    Contents, Format, Frame, LoadAction, MergeReason, Options, PassKind, Plan, StoreAction, Texture,
    TextureDesc,
};

fn reason(plan: &Plan, name: &str) -> MergeReason {
    plan.merge_reason(pass(plan, name)).unwrap()
}

/// `first` and `second` draw into one texture, and `change` says what else `second` does.
fn two_passes(change: impl FnOnce(&mut Frame<'_>, &mut Texture)) -> Plan {
    let mut frame = Frame::new();
    frame.fix_order();
    let mut target = color(&mut frame, "target");
    draw(&mut frame, "first", &mut target, BLACK);
    change(&mut frame, &mut target);
    frame.export_texture(&target);
    plan(frame)
}

#[test]
fn neighbours_with_the_same_attachments_share_a_render_pass() {
    let plan = two_passes(|frame, target| {
        draw(frame, "second", target, Contents::Preserve);
    });
    assert_eq!(steps(&plan), [["first", "second"]]);
    assert_eq!((reason(&plan, "first"), reason(&plan, "second")), (MergeReason::First, MergeReason::Merged));
    assert_eq!(ops(&plan, "first", 0).store, StoreAction::Continue);
    assert_eq!(ops(&plan, "second", 0).load, LoadAction::Continue);
    assert_eq!(ops(&plan, "second", 0).store, StoreAction::Store);
}

#[test]
fn tiles_of_an_atlas_become_one_render_pass() {
    let mut frame = Frame::new();
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(64, 64, Format::Depth32Float));
    for index in 0..4 {
        frame.render_pass(format_args!("tile {index}")).subresource(quarter(index)).depth(&mut atlas, FAR);
    }
    frame.export_texture(&atlas);
    let plan = plan(frame);
    assert_eq!(steps(&plan).len(), 1);
    let drawn = (0..4).filter(|index| ops(&plan, &format!("tile {index}"), 0).clear_drawn);
    assert_eq!(drawn.count(), 0, "the load operation of the first clears all four");
}

#[test]
fn a_tile_cleared_to_another_value_is_drawn_within_the_render_pass() {
    let mut frame = Frame::new();
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(64, 64, Format::Depth32Float));
    for index in 0..4 {
        let value = if index == 2 { Contents::clear_depth(1.0) } else { FAR };
        frame.render_pass(format_args!("tile {index}")).subresource(quarter(index)).depth(&mut atlas, value);
    }
    frame.export_texture(&atlas);
    let plan = plan(frame);
    assert_eq!(steps(&plan).len(), 1);
    let drawn = [0, 1, 2, 3].map(|index| ops(&plan, &format!("tile {index}"), 0).clear_drawn);
    assert_eq!(drawn, [false, false, true, false]);
}

#[test]
fn merging_can_be_switched_off() {
    let mut frame = Frame::new();
    frame.set_options(Options { merge: false, ..Options::default() });
    let mut target = color(&mut frame, "target");
    draw(&mut frame, "first", &mut target, BLACK);
    draw(&mut frame, "second", &mut target, Contents::Preserve);
    frame.export_texture(&target);
    let plan = plan(frame);
    assert_eq!(steps(&plan).len(), 2);
    assert_eq!(reason(&plan, "second"), MergeReason::Off);
}

#[test]
fn only_render_passes_merge() {
    let plan = two_passes(|frame, target| {
        let mut compute = frame.compute_pass("compute");
        compute.keep();
        draw(frame, "second", target, Contents::Preserve);
    });
    assert_eq!(reason(&plan, "compute"), MergeReason::Kind(PassKind::Compute));
    assert_eq!(reason(&plan, "second"), MergeReason::KindBefore(PassKind::Compute));
    assert_eq!(steps(&plan).len(), 3);
}

#[test]
fn passes_with_other_attachments_do_not_merge() {
    let plan = two_passes(|frame, target| {
        let mut other = color(frame, "other");
        let mut second = frame.render_pass("second");
        second.color(target, Contents::Preserve);
        second.color(&mut other, BLACK);
    });
    assert_eq!(reason(&plan, "second"), MergeReason::Attachments);
}

#[test]
fn the_order_of_attachments_matters_for_merging() {
    let mut frame = Frame::new();
    let (mut a, mut b) = (color(&mut frame, "a"), color(&mut frame, "b"));
    let mut first = frame.render_pass("first");
    first.color(&mut a, BLACK);
    first.color(&mut b, BLACK);
    let mut second = frame.render_pass("second");
    second.color(&mut b, Contents::Preserve);
    second.color(&mut a, Contents::Preserve);
    frame.export_texture(&a);
    frame.export_texture(&b);
    assert_eq!(reason(&plan(frame), "second"), MergeReason::Attachments);
}

#[test]
fn another_mip_or_layer_is_another_attachment() {
    let mut frame = Frame::new();
    let mut layers = frame.create_texture("layers", TextureDesc::d2(64, 64, Format::Rgba8Unorm).layers(2));
    for layer in 0..2 {
        let subresource = crate::Subresource::FULL.layer(layer);
        frame.render_pass(format_args!("layer {layer}")).subresource(subresource).color(&mut layers, BLACK);
    }
    frame.export_texture(&layers);
    assert_eq!(reason(&plan(frame), "layer 1"), MergeReason::Attachments);
}

#[test]
fn read_only_depth_differs_from_written_depth() {
    let mut frame = Frame::new();
    let mut depth = depth(&mut frame, "depth");
    frame.render_pass("write").depth(&mut depth, FAR);
    let mut test = frame.render_pass("test");
    test.depth_read(&depth);
    test.keep();
    assert_eq!(reason(&plan(frame), "test"), MergeReason::Attachments);
}

#[test]
fn a_pass_does_not_read_what_its_render_pass_writes() {
    let mut frame = Frame::new();
    let (mut a, mut b) = (color(&mut frame, "a"), color(&mut frame, "b"));
    let mut first = frame.render_pass("first");
    first.color(&mut a, BLACK);
    first.storage_texture_mut(&mut b, Contents::Overwrite);
    let first = first.id();
    let mut second = frame.render_pass("second");
    second.color(&mut a, Contents::Preserve);
    second.storage_texture(&b);
    frame.export_texture(&a);
    assert_eq!(reason(&plan(frame), "second"), MergeReason::Reads(b.id(), first));
}

#[test]
fn a_pass_does_not_write_what_its_render_pass_uses() {
    let mut frame = Frame::new();
    let (mut a, mut b) = (color(&mut frame, "a"), color(&mut frame, "b"));
    draw(&mut frame, "fill", &mut b, BLACK);
    let mut first = frame.render_pass("first");
    first.color(&mut a, BLACK);
    first.sample(&b);
    let first = first.id();
    let mut second = frame.render_pass("second");
    second.color(&mut a, Contents::Preserve);
    second.storage_texture_mut(&mut b, Contents::Overwrite);
    frame.export_texture(&a);
    frame.export_texture(&b);
    assert_eq!(reason(&plan(frame), "second"), MergeReason::Writes(b.id(), first));
}

#[test]
fn a_clear_of_a_whole_attachment_begins_a_render_pass() {
    let mut frame = Frame::new();
    frame.fix_order();
    let (mut a, mut b) = (color(&mut frame, "a"), color(&mut frame, "b"));
    let mut both = |name: &str, b_contents| {
        let mut pass = frame.render_pass(name);
        pass.color(&mut a, if name == "first" { BLACK } else { Contents::Preserve });
        pass.color(&mut b, b_contents);
    };
    both("first", BLACK);
    both("second", BLACK);
    frame.export_texture(&a);
    frame.export_texture(&b);
    assert_eq!(reason(&plan(frame), "second"), MergeReason::Clears(b.id()));
}

#[test]
fn no_pass_is_merged_after_a_resolve() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(64, 64, Format::Rgba8Unorm);
    let mut samples = frame.create_texture("samples", TextureDesc { samples: 4, ..desc });
    let mut target = frame.create_texture("target", desc);
    let mut first = frame.render_pass("first");
    first.color(&mut samples, BLACK);
    let mut second = frame.render_pass("second");
    second.color(&mut samples, Contents::Preserve);
    second.resolve(&mut target);
    let mut third = frame.render_pass("third");
    third.color(&mut samples, Contents::Preserve);
    third.keep();
    frame.export_texture(&target);
    let plan = plan(frame);
    assert_eq!(
        steps(&plan),
        [vec!["first", "second"], vec!["third"]],
        "the last of a render pass may resolve"
    );
    assert_eq!(reason(&plan, "third"), MergeReason::Resolves(target.id()));
}

#[test]
fn a_culled_pass_has_no_reason_to_merge() {
    let mut frame = Frame::new();
    let mut target = color(&mut frame, "target");
    let culled = draw(&mut frame, "culled", &mut target, BLACK);
    assert_eq!(plan(frame).merge_reason(culled), None);
}
