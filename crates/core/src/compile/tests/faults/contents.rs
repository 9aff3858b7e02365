//! Faults in the load, clear and store operations of attachments.

use super::{Stage, Work, search};
use crate::access::{Access, ClearValue, Contents};
use crate::compile::tests::oracle::Rule;
use crate::plan::{AttachmentOps, LoadAction, StoreAction};

const CONTENTS: [Rule; 2] = [Rule::Contents, Rule::Survival];

/// Falsifies the last operations that `falsify` has a use for.
fn change(
    stage: Stage,
    work: &mut Work,
    falsify: impl Fn(AttachmentOps, Access) -> Option<AttachmentOps>,
) -> Option<bool> {
    if stage != Stage::Ops {
        return None;
    }
    let accesses = work.plan.decl.accesses.iter().map(|access| access.access);
    for (ops, access) in work.plan.ops.iter_mut().zip(accesses).rev() {
        if let Some(own) = ops
            && let Some(falsified) = falsify(*own, access)
        {
            *ops = Some(falsified);
            return Some(true);
        }
    }
    Some(false)
}

fn zero(access: Access) -> ClearValue {
    if access == Access::Depth { ClearValue::Depth(0.0) } else { ClearValue::Color([0.0; 4]) }
}

#[test]
fn a_discard_too_soon() {
    let discard = |ops: AttachmentOps, _| {
        (ops.store == StoreAction::Store).then_some(AttachmentOps { store: StoreAction::Discard, ..ops })
    };
    search(&CONTENTS, |stage, work| change(stage, work, discard)).always_caught();
}

#[test]
fn a_store_for_nothing() {
    let store = |ops: AttachmentOps, _| {
        (ops.store == StoreAction::Discard).then_some(AttachmentOps { store: StoreAction::Store, ..ops })
    };
    search(&[Rule::Waste], |stage, work| change(stage, work, store)).always_caught();
}

#[test]
fn a_load_turned_into_a_clear() {
    let clear = |ops: AttachmentOps, access| {
        let load = LoadAction::Clear(zero(access));
        (ops.load == LoadAction::Load).then_some(AttachmentOps { load, ..ops })
    };
    search(&CONTENTS, |stage, work| change(stage, work, clear)).always_caught();
}

#[test]
fn a_clear_turned_into_a_load_of_the_previous_resource_in_the_slot() {
    let load = |ops: AttachmentOps, _| {
        let clears = matches!(ops.load, LoadAction::Clear(_));
        clears.then_some(AttachmentOps { load: LoadAction::Load, ..ops })
    };
    search(&[Rule::Contents, Rule::Waste], |stage, work| change(stage, work, load)).always_caught();
}

#[test]
fn a_clear_to_another_value() {
    let other = |ops: AttachmentOps, _| match ops.load {
        LoadAction::Clear(ClearValue::Color(_)) => {
            Some(AttachmentOps { load: LoadAction::Clear(ClearValue::Color([7.0; 4])), ..ops })
        }
        LoadAction::Clear(ClearValue::Depth(_)) => {
            Some(AttachmentOps { load: LoadAction::Clear(ClearValue::Depth(0.125)), ..ops })
        }
        _ => None,
    };
    // What is covered may be cleared to anything.
    search(&[Rule::Contents], |stage, work| change(stage, work, other)).caught(100);
}

#[test]
fn a_clear_of_a_region_that_is_not_drawn() {
    let forget =
        |ops: AttachmentOps, _| ops.clear_drawn.then_some(AttachmentOps { clear_drawn: false, ..ops });
    // Now and then the load operation of an earlier pass has left the same value there.
    search(&[Rule::Contents], |stage, work| change(stage, work, forget)).caught(50);
}

#[test]
fn a_clear_of_a_region_by_a_load_operation() {
    let clear = |stage, work: &mut Work| {
        for index in (stage == Stage::Ops).then_some(0..work.plan.ops.len())? {
            let declared = work.plan.decl.contents(&work.plan.decl.accesses[index]);
            if let (Some(ops), Some(Contents::Clear(value))) = (&mut work.plan.ops[index], declared)
                && ops.clear_drawn
                && ops.load == LoadAction::Load
            {
                (ops.load, ops.clear_drawn) = (LoadAction::Clear(value), false);
                return Some(true);
            }
        }
        Some(false)
    };
    search(&CONTENTS, clear).always_caught();
}

#[test]
fn a_pass_that_loads_within_a_render_pass() {
    let load = |ops: AttachmentOps, _| {
        let continues = ops.load == LoadAction::Continue;
        continues.then_some(AttachmentOps { load: LoadAction::Load, ..ops })
    };
    search(&[Rule::Contents], |stage, work| change(stage, work, load)).always_caught();
}

#[test]
fn an_attachment_that_is_never_stored() {
    let leave = |ops: AttachmentOps, _| {
        let ends = ops.store != StoreAction::Continue;
        ends.then_some(AttachmentOps { store: StoreAction::Continue, ..ops })
    };
    search(&[Rule::Contents], |stage, work| change(stage, work, leave)).always_caught();
}
