//! The stages of the compiler, run one by one, so that the result of each can be falsified.

use crate::compile::{alias, cull, hazards, lifetime, merge, ops, order};
use crate::declaration::Declaration;
use crate::handle::SlotId;
use crate::plan::Plan;

/// The stage that has just been run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    Cull,
    Hazards,
    Order,
    Merge,
    Lifetime,
    Ops,
    Alias,
}

/// The plan as far as it is made.
pub(super) struct Work {
    pub(super) plan: Plan,
    pub(super) uses: Vec<lifetime::Use>,
}

/// Compiles a valid declaration as the compiler does, and shows the work after each stage.
pub(super) fn compile(decl: Declaration, mut after: impl FnMut(Stage, &mut Work)) -> Plan {
    let mut work = Work { plan: Plan { decl, ..Plan::default() }, uses: Vec::new() };
    work.plan.ops = vec![None; work.plan.decl.accesses.len()];
    work.plan.culled = cull::cull(&work.plan.decl);
    after(Stage::Cull, &mut work);
    work.plan.dependencies = hazards::hazards(&work.plan.decl, &work.plan.culled);
    after(Stage::Hazards, &mut work);
    let plan = &mut work.plan;
    (plan.order, plan.order_reasons) = order::order(&plan.decl, &plan.culled, &plan.dependencies);
    after(Stage::Order, &mut work);
    let plan = &mut work.plan;
    (plan.steps, plan.merge_reasons) = merge::merge(&plan.decl, &plan.order);
    after(Stage::Merge, &mut work);
    work.uses = lifetime::uses(&work.plan.decl, &work.plan.order, &work.plan.steps);
    after(Stage::Lifetime, &mut work);
    work.plan.ops = ops::ops(&work.plan.decl, &work.plan.order, &work.plan.steps);
    after(Stage::Ops, &mut work);
    let plan = &mut work.plan;
    let aliasing = alias::alias(&plan.decl, &work.uses, plan.steps.len());
    (plan.placements, plan.slots, plan.slot_resources) =
        (aliasing.placements, aliasing.slots, aliasing.resources);
    after(Stage::Alias, &mut work);
    work.plan
}

impl Work {
    /// Moves a resource to another slot, and lists it there.
    pub(super) fn move_to(&mut self, resource: usize, slot: SlotId) {
        let plan = &mut self.plan;
        plan.placements[resource].slot = Some(slot);
        let mut assigned: Vec<usize> =
            (0..plan.placements.len()).filter(|&r| plan.placements[r].slot.is_some()).collect();
        assigned.sort_by_key(|&r| (plan.placements[r].slot, plan.placements[r].steps));
        plan.slot_resources = assigned.iter().map(|&r| crate::ResourceId(r as u32)).collect();
        for (index, slot) in plan.slots.iter_mut().enumerate() {
            let own = |r: &&usize| plan.placements[**r].slot == Some(SlotId(index as u32));
            let start = assigned.iter().position(|r| own(&r)).unwrap_or(0) as u32;
            slot.resources = (start, start + assigned.iter().filter(own).count() as u32);
            for r in assigned.iter().filter(own) {
                slot.texture_usage |= plan.placements[*r].texture_usage;
                slot.buffer_usage |= plan.placements[*r].buffer_usage;
            }
        }
    }
}
