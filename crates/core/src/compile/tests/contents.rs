//! Consequences of contents: culling, loads and stores, usages, dependencies.

use super::helpers::{BLACK, FAR, accesses, color, depth, filter, look, ops, order, pass, plan};
use crate::{
    Contents, CullReason, DependencyKind, Format, Frame, LoadAction, LoadReason, StoreAction, StoreReason,
    TextureDesc, TextureUsages,
};

#[test]
fn a_pass_nothing_needs_is_culled_with_its_producers() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    let unused = filter(&mut frame, "unused", &a);
    filter(&mut frame, "debug", &unused);
    frame.export_texture(&a);
    let plan = plan(frame);
    assert_eq!(order(&plan), ["draw"]);
    assert_eq!(plan.culled_count(), 2);
    let reason = |name| plan.pass(pass(&plan, name)).culled.unwrap();
    assert_eq!(reason("unused"), CullReason::OnlyCulledReaders(unused.id(), pass(&plan, "debug")));
    assert_eq!(plan.describe_cull(reason("debug")), "nothing reads `debug`");
}

#[test]
fn a_pass_that_writes_nothing_is_culled_and_says_so() {
    let mut frame = Frame::new();
    frame.encoder_pass("idle");
    let plan = plan(frame);
    assert_eq!(plan.pass(pass(&plan, "idle")).culled, Some(CullReason::WritesNothing));
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
    assert_eq!(order(&plan), ["draw"]);
    assert_eq!(
        [0, 1].map(|index| ops(&plan, "draw", index).store),
        [StoreAction::Discard, StoreAction::Store]
    );
}

#[test]
fn a_write_overwritten_before_it_is_read_is_culled() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("first").color(&mut a, BLACK);
    frame.render_pass("second").color(&mut a, Contents::Overwrite);
    frame.export_texture(&a);
    let plan = plan(frame);
    let (first, second) = (pass(&plan, "first"), pass(&plan, "second"));
    assert_eq!(plan.pass(first).culled, Some(CullReason::Overwritten(a.id(), second)));
    assert_eq!(plan.pass(second).culled, None);
}

#[test]
fn a_kept_pass_and_its_producers_run() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    let mut effect = frame.encoder_pass("effect");
    effect.sample(&a);
    effect.keep();
    assert_eq!(order(&plan(frame)), ["draw", "effect"]);
}

#[test]
fn writing_an_import_is_a_root() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
    let mut out = frame.declare_import_texture("surface", desc, TextureUsages::RENDER_ATTACHMENT, false);
    frame.render_pass("draw").color(&mut out, BLACK);
    let plan = plan(frame);
    let ops = ops(&plan, "draw", 0);
    assert_eq!((ops.store, ops.store_reason), (StoreAction::Store, StoreReason::Imported));
    assert_eq!(plan.slots().len(), 0);
}

#[test]
fn a_history_is_written_for_the_next_frame() {
    let mut frame = Frame::new();
    let mut history =
        frame.history("glow", TextureDesc::d2(64, 64, Format::Rgba16Float), crate::Resize::Reset);
    let mut pass = frame.render_pass("accumulate");
    pass.sample(&history.previous);
    pass.color(&mut history.current, Contents::Overwrite);
    let plan = plan(frame);
    assert_eq!(order(&plan), ["accumulate"]);
    let ops = ops(&plan, "accumulate", 1);
    assert_eq!((ops.store, ops.store_reason), (StoreAction::Store, StoreReason::History));
    assert_eq!(plan.slots().len(), 0, "the halves of a history live with the graph");
}

#[test]
fn loads_and_stores_follow_from_contents_and_say_why() {
    let mut frame = Frame::new();
    let mut depth = depth(&mut frame, "depth");
    let mut hdr = frame.create_texture("hdr", TextureDesc::d2(64, 64, Format::Rgba16Float));
    frame.render_pass("prepass").depth(&mut depth, FAR);
    let mut main = frame.render_pass("main");
    main.color(&mut hdr, BLACK);
    main.depth(&mut depth, Contents::Preserve);
    let out = filter(&mut frame, "tonemap", &hdr);
    frame.export_texture(&out);
    let plan = plan(frame);
    let (prepass, main, tonemap) = (pass(&plan, "prepass"), pass(&plan, "main"), pass(&plan, "tonemap"));
    assert_eq!(ops(&plan, "prepass", 0).store_reason, StoreReason::NeededBy(main));
    assert_eq!(ops(&plan, "main", 0).store_reason, StoreReason::NeededBy(tonemap));
    assert_eq!(ops(&plan, "main", 1).load, LoadAction::Load);
    assert_eq!(ops(&plan, "main", 1).load_reason, LoadReason::Preserves(prepass));
    assert_eq!(ops(&plan, "main", 1).store, StoreAction::Discard);
    assert_eq!(ops(&plan, "main", 1).store_reason, StoreReason::LastUse);
    assert_eq!(ops(&plan, "tonemap", 1).load_reason, LoadReason::Overwritten);
    assert_eq!(ops(&plan, "tonemap", 1).store_reason, StoreReason::Exported);
}

#[test]
fn the_contents_of_an_import_are_loaded() {
    let mut frame = Frame::new();
    let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
    let mut out = frame.declare_import_texture("canvas", desc, TextureUsages::RENDER_ATTACHMENT, true);
    frame.render_pass("draw").color(&mut out, Contents::Preserve);
    let plan = plan(frame);
    let ops = ops(&plan, "draw", 0);
    assert_eq!((ops.load, ops.load_reason), (LoadAction::Load, LoadReason::PreservesImport));
}

#[test]
fn contents_overwritten_by_a_pass_that_runs_for_another_reason_are_discarded() {
    let mut frame = Frame::new();
    let (mut a, mut b) = (color(&mut frame, "a"), color(&mut frame, "b"));
    let mut first = frame.render_pass("first");
    first.color(&mut a, BLACK);
    first.color(&mut b, BLACK);
    frame.render_pass("second").color(&mut a, BLACK);
    frame.export_texture(&a);
    frame.export_texture(&b);
    let plan = plan(frame);
    let ops = ops(&plan, "first", 0);
    let second = pass(&plan, "second");
    assert_eq!((ops.store, ops.store_reason), (StoreAction::Discard, StoreReason::OverwrittenBy(second)));
}

#[test]
fn read_only_depth_has_no_operations() {
    let mut frame = Frame::new();
    let mut depth = depth(&mut frame, "depth");
    frame.render_pass("prepass").depth(&mut depth, FAR);
    let mut out = color(&mut frame, "out");
    let mut main = frame.render_pass("main");
    main.depth_read(&depth);
    main.color(&mut out, BLACK);
    frame.export_texture(&out);
    let plan = plan(frame);
    assert_eq!(accesses(&plan, "main")[0].ops, None);
    assert_eq!(ops(&plan, "prepass", 0).store, StoreAction::Store);
}

#[test]
fn usages_are_those_of_passes_that_run() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("draw").color(&mut a, BLACK);
    frame.compute_pass("culled").storage_texture(&a);
    filter(&mut frame, "also culled", &a);
    look(&mut frame, "kept", &a);
    let plan = plan(frame);
    let usage = plan.resource(a.id()).texture_usage;
    assert_eq!(usage, TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING);
}

#[test]
fn dependencies_distinguish_the_three_hazards() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("write").color(&mut a, BLACK);
    let b = filter(&mut frame, "read", &a);
    frame.render_pass("again").color(&mut a, BLACK);
    frame.export_texture(&a);
    frame.export_texture(&b);
    let plan = plan(frame);
    let kinds: Vec<_> = plan.dependencies().iter().map(|d| (d.before.0, d.after.0, d.kind)).collect();
    let expected = [
        (0, 1, DependencyKind::ReadAfterWrite),
        (0, 2, DependencyKind::WriteAfterWrite),
        (1, 2, DependencyKind::WriteAfterRead),
    ];
    assert_eq!(kinds, expected);
    assert_eq!(plan.graph().edge_count(), 3);
}

#[test]
fn two_reads_do_not_order_each_other() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    frame.render_pass("write").color(&mut a, BLACK);
    look(&mut frame, "one", &a);
    look(&mut frame, "other", &a);
    let plan = plan(frame);
    assert_eq!(plan.dependencies().len(), 2, "each depends on the write alone");
}

#[test]
fn an_upload_nobody_reads_costs_nothing() {
    let mut frame = Frame::new();
    frame.upload_buffer("unused", &[0u8; 16][..]);
    let plan = plan(frame);
    assert_eq!(plan.order().len(), 0);
    assert_eq!(plan.slots().len(), 0);
}
