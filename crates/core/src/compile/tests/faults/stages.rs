//! The compiler's stages one by one, so that what one hands to the next can be falsified.

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
    (plan.order, plan.placed) = order::order(&plan.decl, &plan.culled, &plan.dependencies);
    after(Stage::Order, &mut work);
    let plan = &mut work.plan;
    (plan.steps, plan.merges) = merge::merge(&plan.decl, &plan.order);
    after(Stage::Merge, &mut work);
    work.uses = lifetime::uses(&work.plan.decl, &work.plan.order, &work.plan.steps);
    after(Stage::Lifetime, &mut work);
    work.plan.ops = ops::ops(&work.plan.decl, &work.plan.order, &work.plan.steps);
    after(Stage::Ops, &mut work);
    let plan = &mut work.plan;
    let aliasing = alias::alias(&plan.decl, &work.uses, plan.steps.len());
    (plan.fates, plan.slots, plan.tenants) = (aliasing.fates, aliasing.slots, aliasing.tenants);
    after(Stage::Alias, &mut work);
    work.plan
}

impl Work {
    /// Moves a resource to another slot, and lists it there.
    pub(super) fn move_to(&mut self, resource: usize, slot: SlotId) {
        let plan = &mut self.plan;
        plan.fates[resource].slot = Some(slot);
        let mut housed: Vec<usize> =
            (0..plan.fates.len()).filter(|&r| plan.fates[r].slot.is_some()).collect();
        housed.sort_by_key(|&r| (plan.fates[r].slot, plan.fates[r].steps));
        plan.tenants = housed.iter().map(|&r| crate::ResourceId(r as u32)).collect();
        for (index, slot) in plan.slots.iter_mut().enumerate() {
            let own = |r: &&usize| plan.fates[**r].slot == Some(SlotId(index as u32));
            let start = housed.iter().position(|r| own(&r)).unwrap_or(0) as u32;
            slot.tenants = (start, start + housed.iter().filter(own).count() as u32);
            for r in housed.iter().filter(own) {
                slot.texture_usage |= plan.fates[*r].texture_usage;
                slot.buffer_usage |= plan.fates[*r].buffer_usage;
            }
        }
    }
}
