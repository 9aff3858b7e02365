//! Order of passes.

use super::helpers::{BLACK, color, depends, draw, filter, look, order, pass, plan};
use crate::{Contents, Format, Frame, Options, OrderPolicy, OrderReason, Plan, Texture, TextureDesc};

fn sized(frame: &mut Frame<'_>, name: &str, side: u32) -> Texture {
    frame.create_texture(name, TextureDesc::d2(side, side, Format::Rgba8Unorm))
}

/// Reads all of `from` in a pass that overwrites `to`.
fn combine(frame: &mut Frame<'_>, name: &str, from: &[&Texture], to: &mut Texture) {
    let mut pass = frame.compute_pass(name);
    for from in from {
        pass.sample(from);
    }
    pass.storage_texture_mut(to, Contents::Overwrite);
}

#[test]
fn passes_that_free_memory_run_before_passes_that_need_more() {
    let mut frame = Frame::new();
    let (mut big, mut small, mut other, mut result) = (
        sized(&mut frame, "big", 64),
        sized(&mut frame, "small", 8),
        sized(&mut frame, "other", 64),
        sized(&mut frame, "result", 8),
    );
    combine(&mut frame, "fill big", &[], &mut big);
    combine(&mut frame, "fill other", &[], &mut other);
    combine(&mut frame, "shrink big", &[&big], &mut small);
    combine(&mut frame, "end", &[&small, &other], &mut result);
    frame.export_texture(&result);
    let plan = plan(frame);
    assert_eq!(order(&plan), ["fill big", "shrink big", "fill other", "end"]);
    let freed = 64 * 64 * 4 - 8 * 8 * 4;
    assert_eq!(plan.order_reason(pass(&plan, "shrink big")), Some(OrderReason::FreesMemory(freed)));
}

#[test]
fn equally_good_passes_run_in_order_of_declaration() {
    let mut frame = Frame::new();
    let names = ["c", "a", "b"];
    let made = names.map(|name| {
        let mut texture = color(&mut frame, name);
        draw(&mut frame, name, &mut texture, BLACK);
        texture
    });
    for texture in &made {
        frame.export_texture(texture);
    }
    let plan = plan(frame);
    assert_eq!(order(&plan), names);
    assert_eq!(plan.order_reason(pass(&plan, "c")), Some(OrderReason::DeclaredFirst));
    assert_eq!(plan.order_reason(pass(&plan, "b")), Some(OrderReason::OnlyReady));
}

/// Two passes that draw into `target`, with one of another target declared between them.
fn interrupted(order: OrderPolicy) -> Frame<'static> {
    let mut frame = Frame::new();
    frame.set_options(Options { order, ..Options::default() });
    let (mut target, mut other) = (color(&mut frame, "target"), color(&mut frame, "other"));
    draw(&mut frame, "first", &mut target, BLACK);
    draw(&mut frame, "between", &mut other, BLACK);
    draw(&mut frame, "second", &mut target, Contents::Preserve);
    frame.export_texture(&target);
    frame.export_texture(&other);
    frame
}

#[test]
fn a_pass_that_continues_the_open_render_pass_runs_next() {
    let plan = plan(interrupted(OrderPolicy::Automatic));
    assert_eq!(order(&plan), ["first", "second", "between"]);
    assert_eq!(plan.order_reason(pass(&plan, "second")), Some(OrderReason::ContinuesRenderPass));
}

#[test]
fn a_frame_can_fix_the_order_by_one_call() {
    let mut frame = interrupted(OrderPolicy::Automatic);
    frame.fix_order();
    let plan = plan(frame);
    assert_eq!(order(&plan), ["first", "between", "second"]);
    assert!(plan.order().iter().all(|&id| plan.order_reason(id) == Some(OrderReason::Fixed)));
    assert_eq!(plan.options().order, OrderPolicy::Declared);
}

#[test]
fn an_explicit_order_holds_and_keeps_no_pass() {
    let mut frame = Frame::new();
    let culled = frame.encoder_pass("culled").id();
    let mut late = frame.encoder_pass("late");
    late.keep();
    late.after(culled);
    let late = late.id();
    let mut last = frame.encoder_pass("last");
    last.keep();
    last.after(late);
    let plan = plan(frame);
    assert_eq!(order(&plan), ["late", "last"]);
    assert!(depends(&plan, "last", "late"));
    assert_eq!(plan.dependencies().len(), 1, "a culled pass orders nothing");
}

#[test]
fn an_explicit_order_has_priority_over_memory() {
    let passes = |by_name: bool| {
        let mut frame = Frame::new();
        let (mut large, mut small) = (sized(&mut frame, "large", 64), sized(&mut frame, "small", 8));
        let fill = draw(&mut frame, "fill", &mut large, BLACK);
        look(&mut frame, "look", &large);
        let mut other = frame.compute_pass("other");
        other.storage_texture_mut(&mut small, Contents::Overwrite);
        other.keep();
        if by_name {
            other.after(fill);
        }
        plan(frame)
    };
    assert_eq!(order(&passes(false)), ["other", "fill", "look"]);
    assert_eq!(order(&passes(true)), ["fill", "look", "other"]);
}

/// Three passes: `first` makes what `second` makes more of, and `other` has nothing to do with them. What
/// `second` and `other` make is exported.
fn three(declared: [&str; 3], sides: [u32; 3]) -> Plan {
    let mut frame = Frame::new();
    let [mut first, mut second, mut other] = sides.map(|side| sized(&mut frame, "texture", side));
    for name in declared {
        match name {
            "first" => combine(&mut frame, name, &[], &mut first),
            "second" => combine(&mut frame, name, &[&first], &mut second),
            _ => combine(&mut frame, name, &[], &mut other),
        }
    }
    frame.export_texture(&second);
    frame.export_texture(&other);
    plan(frame)
}

#[test]
fn the_order_of_declaration_is_used_if_it_needs_less_memory() {
    // `other` is the smallest, so a greedy choice runs it first, and it stays in use while the others run.
    let plan = three(["first", "second", "other"], [16, 16, 8]);
    assert_eq!(order(&plan), ["first", "second", "other"]);
    assert_eq!(plan.order_reason(plan.order()[0]), Some(OrderReason::DeclarationNeedsLess));
}

#[test]
fn passes_are_chosen_from_last_to_first_if_that_needs_less_memory() {
    // Declared first, `other` is in the way both as declared and step by step.
    let plan = three(["other", "first", "second"], [16, 16, 8]);
    assert_eq!(order(&plan), ["first", "second", "other"]);
    assert_eq!(plan.order_reason(plan.order()[0]), Some(OrderReason::BackwardsNeedsLess));
}

#[test]
fn a_reader_runs_before_its_texture_is_overwritten() {
    let mut frame = Frame::new();
    let mut a = color(&mut frame, "a");
    draw(&mut frame, "one", &mut a, BLACK);
    let kept = filter(&mut frame, "keep", &a);
    draw(&mut frame, "two", &mut a, BLACK);
    look(&mut frame, "look", &a);
    frame.export_texture(&kept);
    assert_eq!(order(&plan(frame)), ["one", "keep", "two", "look"]);
}
