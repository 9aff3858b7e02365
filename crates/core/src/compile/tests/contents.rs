//! What follows from contents: culling, loads and stores, and the order.

use super::{BLACK, color, filter, pass, plan};
use crate::{Contents, CullReason, DependencyKind, Format, Frame, LoadAction, LoadReason, TextureDesc};
use crate::{StoreAction, StoreReason, TextureUsages};

#[test]
fn a_pass_nothing_needs_is_culled_with_its_producers() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    let unused = filter(&mut frame, "unused", &a);
    filter(&mut frame, "debug", &unused);
    frame.export_texture(&a);
    let plan = plan(frame);
    assert_eq!(plan.live_passes().count(), 1);
    let reason = |name| plan.passes[pass(&plan, name).index()].culled.unwrap();
    assert_eq!(reason("unused"), CullReason::OnlyCulledReaders(unused.id(), pass(&plan, "debug")));
    assert_eq!(plan.cull_words(reason("debug")), "nothing reads `debug`");
}

#[test]
fn a_pass_with_two_outputs_lives_if_one_is_needed() {
    let mut frame = Frame::new();
    let (mut a, mut b) = (color(&mut frame, "a"), color(&mut frame, "b"));
    let mut draw = frame.render_pass("draw");
    draw.color(&mut a, BLACK);
    draw.color(&mut b, BLACK);
    frame.export_texture(&b);
    let plan = plan(frame);
    assert_eq!(plan.live_passes().count(), 1);
    let ops: Vec<_> = plan.passes[0].accesses.iter().map(|a| a.ops.unwrap().store).collect();
    assert_eq!(ops, [StoreAction::Discard, StoreAction::Store]);
}

#[test]
fn what_is_overwritten_before_it_is_read_is_culled() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("first").color(&mut a, BLACK);
    frame.render_pass("second").color(&mut a, Contents::Cover);
    frame.export_texture(&a);
    let plan = plan(frame);
    let (first, second) = (pass(&plan, "first"), pass(&plan, "second"));
    assert_eq!(plan.pass(first).culled, Some(CullReason::Overwritten(a.id(), second)));
    assert_eq!(plan.pass(second).culled, None);
}

#[test]
fn a_kept_pass_and_what_it_reads_live() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    let mut effect = frame.encoder_pass("effect");
    effect.sample(&a);
    effect.keep();
    assert_eq!(plan(frame).live_passes().count(), 2);
}

#[test]
fn writing_an_import_is_a_root() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
    let mut out = frame.declare_import_texture("surface", desc, TextureUsages::RENDER_ATTACHMENT, false);
    frame.render_pass("draw").color(&mut out, BLACK);
    let plan = plan(frame);
    let ops = plan.passes[0].accesses[0].ops.unwrap();
    assert_eq!((ops.store, ops.store_reason), (StoreAction::Store, StoreReason::Imported));
    assert_eq!(plan.slots.len(), 0);
}

#[test]
fn loads_and_stores_follow_from_contents_and_say_why() {
    let mut frame = Frame::new();
    let mut depth = frame.create_texture("depth", TextureDesc::d2(64, 64, Format::Depth32Float));
    let mut hdr = frame.create_texture("hdr", TextureDesc::d2(64, 64, Format::Rgba16Float));
    frame.render_pass("prepass").depth(&mut depth, Contents::clear_depth(0.0));
    let mut main = frame.render_pass("main");
    main.color(&mut hdr, BLACK);
    main.depth(&mut depth, Contents::Preserve);
    let out = filter(&mut frame, "tonemap", &hdr);
    frame.export_texture(&out);
    let plan = plan(frame);
    let ops = |name: &str, index: usize| plan.pass(pass(&plan, name)).accesses[index].ops.unwrap();
    let (prepass, main, tonemap) = (pass(&plan, "prepass"), pass(&plan, "main"), pass(&plan, "tonemap"));
    assert_eq!(ops("prepass", 0).store_reason, StoreReason::NeededBy(main));
    assert_eq!(ops("main", 0).store_reason, StoreReason::NeededBy(tonemap));
    assert_eq!(ops("main", 1).load, LoadAction::Load);
    assert_eq!(ops("main", 1).load_reason, LoadReason::Preserves(prepass));
    assert_eq!(ops("main", 1).store, StoreAction::Discard);
    assert_eq!(ops("main", 1).store_reason, StoreReason::LastUse);
    assert_eq!(ops("tonemap", 1).load_reason, LoadReason::Covered);
    assert_eq!(ops("tonemap", 1).store_reason, StoreReason::Exported);
}

#[test]
fn usages_are_those_of_passes_that_run() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    frame.compute_pass("culled").storage_texture(&a);
    filter(&mut frame, "also culled", &a);
    let mut keep = frame.compute_pass("kept");
    keep.sample(&a);
    keep.keep();
    let plan = plan(frame);
    let usage = plan.resource(a.id()).texture_usage;
    assert_eq!(usage, TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING);
}

#[test]
fn dependencies_tell_the_three_hazards_apart() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("write").color(&mut a, BLACK);
    let b = filter(&mut frame, "read", &a);
    frame.render_pass("again").color(&mut a, BLACK);
    frame.export_texture(&a);
    frame.export_texture(&b);
    let plan = plan(frame);
    let kinds: Vec<_> = plan.dependencies.iter().map(|d| (d.before.0, d.after.0, d.kind)).collect();
    assert_eq!(
        kinds,
        [
            (0, 1, DependencyKind::ReadAfterWrite),
            (0, 2, DependencyKind::WriteAfterWrite),
            (1, 2, DependencyKind::WriteAfterRead)
        ]
    );
    assert_eq!(plan.graph().edge_count(), 3);
}

#[test]
fn an_upload_nobody_reads_costs_nothing() {
    let mut frame = Frame::new();
    frame.upload_buffer("unused", &[0u8; 16][..]);
    let plan = plan(frame);
    assert_eq!(plan.live_passes().count(), 0);
    assert_eq!(plan.slots.len(), 0);
}
