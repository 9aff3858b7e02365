//! Wrong reasons of right decisions.

use super::{Stage, Work, search};
use crate::compile::tests::oracle::Rule;
use crate::handle::ResourceId;
use crate::plan::{CullReason, LoadReason, MergeReason, OrderReason, SlotReason, StoreReason};

const REASONS: [Rule; 1] = [Rule::Reasons];

#[test]
fn a_false_reason_for_culling() {
    let lie = |stage, work: &mut Work| {
        let writes =
            |reason: &&mut Option<CullReason>| reason.is_some_and(|r| r != CullReason::WritesNothing);
        let culled = (stage == Stage::Cull).then(|| work.plan.culled.iter_mut().find(writes))?;
        culled.map(|reason| *reason = Some(CullReason::WritesNothing)).is_some().into()
    };
    search(&REASONS, lie).always_caught();
}

#[test]
fn a_false_reason_for_a_position() {
    let lie = |stage, work: &mut Work| {
        for reason in (stage == Stage::Order).then_some(&mut work.plan.order_reasons)? {
            *reason = match *reason {
                OrderReason::OnlyReady => OrderReason::FreesMemory(7),
                OrderReason::FreesMemory(bytes) => OrderReason::FreesMemory(bytes + 4),
                OrderReason::DeclaredFirst => OrderReason::OnlyReady,
                _ => OrderReason::OnlyReady,
            };
        }
        Some(!work.plan.order_reasons.is_empty())
    };
    search(&REASONS, lie).caught(600);
}

#[test]
fn a_false_reason_against_a_merge() {
    let lie = |stage, work: &mut Work| {
        for reason in (stage == Stage::Merge).then_some(&mut work.plan.merge_reasons)? {
            *reason = match *reason {
                MergeReason::Kind(_) | MergeReason::KindBefore(_) => MergeReason::Attachments,
                MergeReason::Attachments => MergeReason::Off,
                MergeReason::Clears(resource) => MergeReason::Resolves(resource),
                MergeReason::Reads(resource, pass) => MergeReason::Writes(resource, pass),
                other => other,
            };
        }
        Some(true)
    };
    search(&REASONS, lie).always_caught();
}

#[test]
fn a_false_reason_for_a_load() {
    let lie = |stage, work: &mut Work| {
        for ops in (stage == Stage::Ops).then_some(&mut work.plan.ops)?.iter_mut().flatten() {
            ops.load_reason = match ops.load_reason {
                LoadReason::Declared => LoadReason::Overwritten,
                LoadReason::Overwritten | LoadReason::RestUnneeded => LoadReason::Declared,
                LoadReason::Preserves(_) => LoadReason::PreservesImport,
                LoadReason::RestOutlives | LoadReason::RestNeededBy(_) => LoadReason::RestUnneeded,
                LoadReason::PreservesImport => LoadReason::RestUnneeded,
                LoadReason::Merged => LoadReason::Declared,
            };
        }
        Some(true)
    };
    search(&REASONS, lie).always_caught();
}

#[test]
fn a_false_reason_for_a_store() {
    let lie = |stage, work: &mut Work| {
        let first = *(stage == Stage::Ops).then(|| work.plan.order.first())??;
        for ops in work.plan.ops.iter_mut().flatten() {
            ops.store_reason = match ops.store_reason {
                // What runs first needs nothing of the frame.
                StoreReason::NeededBy(_) => StoreReason::NeededBy(first),
                StoreReason::OverwrittenBy(_) | StoreReason::LastUse => StoreReason::Imported,
                StoreReason::Exported | StoreReason::Imported | StoreReason::History => StoreReason::LastUse,
                StoreReason::Merged => StoreReason::LastUse,
            };
        }
        Some(true)
    };
    search(&REASONS, lie).always_caught();
}

#[test]
fn a_false_reason_for_a_slot() {
    let lie = |stage, work: &mut Work| {
        let placements = (stage == Stage::Alias).then_some(&mut work.plan.placements)?;
        for (index, placement) in placements.iter_mut().enumerate() {
            placement.reason = match placement.reason {
                SlotReason::After(_) => SlotReason::FirstOfClass,
                SlotReason::FirstOfClass => SlotReason::AllBusy(ResourceId(index as u32)),
                SlotReason::AllBusy(other) => SlotReason::After(other),
                SlotReason::Unused => SlotReason::Imported,
                SlotReason::Imported => SlotReason::History,
                SlotReason::History => SlotReason::Unused,
            };
        }
        Some(!work.plan.placements.is_empty())
    };
    search(&REASONS, lie).always_caught();
}
