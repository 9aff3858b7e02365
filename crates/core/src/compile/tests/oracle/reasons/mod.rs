//! Every reason is true for its pass and resource.

mod contents;
mod merging;
mod positions;

use super::super::frames::Names;
use super::{Live, Oracle, Rule, spec_pass};
use crate::{CullReason, PassId, Plan, ResourceId, SlotReason};

/// Facts that the reasons are checked against.
struct Facts<'p> {
    plan: &'p Plan,
    names: &'p Names,
    live: &'p Live,
}

impl Facts<'_> {
    fn resource(&self, id: ResourceId) -> usize {
        self.names.resource(id)
    }

    /// Returns the position of a pass that runs.
    fn position(&self, id: PassId) -> Option<usize> {
        self.live.positions[spec_pass(id)]
    }
}

impl Oracle<'_> {
    pub(super) fn reasons(&mut self, names: &Names, plan: &Plan, live: &Live) {
        let facts = Facts { plan, names, live };
        self.cull_reasons(&facts);
        self.place_reasons(&facts);
        for position in 0..live.order.len() {
            self.merge_reasons(&facts, position);
            self.contents_reasons(&facts, position);
        }
        self.slot_reasons(&facts);
    }

    fn truth(&mut self, holds: bool, subject: impl std::fmt::Debug, reason: impl std::fmt::Debug) {
        self.expect(holds, Rule::Reasons, || format!("{subject:?}: {reason:?} is not so"));
    }

    /// Returns whether an access of the pass uses the resource in such a way.
    fn does(&self, pass: usize, resource: usize, how: impl Fn(&super::AccessSpec) -> bool) -> bool {
        self.model.spec.passes[pass].accesses.iter().any(|a| a.resource == resource && how(a))
    }

    fn cull_reasons(&mut self, facts: &Facts<'_>) {
        for (id, pass) in facts.plan.passes() {
            let Some(reason) = pass.culled else { continue };
            let own = spec_pass(id);
            let writes = |r: ResourceId| self.does(own, facts.resource(r), |a| a.writes());
            let clash = |r: ResourceId, other: PassId| {
                let parts =
                    |pass| self.model.accesses(pass).filter(|(_, a, _)| a.resource == facts.resource(r));
                parts(own)
                    .any(|(_, _, cells)| parts(spec_pass(other)).any(|(_, _, more)| cells.overlaps(&more)))
            };
            let culled = |other: PassId| facts.position(other).is_none();
            let holds = match reason {
                CullReason::WritesNothing => !self.model.spec.passes[own].accesses.iter().any(|a| a.writes()),
                CullReason::Unread(r) => writes(r),
                CullReason::OnlyCulledReaders(r, other) => {
                    other > id && writes(r) && clash(r, other) && culled(other)
                }
                CullReason::Overwritten(r, other) => {
                    let overwrites =
                        self.does(spec_pass(other), facts.resource(r), |a| a.writes() && !a.needs());
                    other > id && writes(r) && clash(r, other) && overwrites && !culled(other)
                }
            };
            self.truth(holds, id, reason);
        }
    }

    fn slot_reasons(&mut self, facts: &Facts<'_>) {
        let slots: Vec<_> = facts.plan.slots().collect();
        for (id, planned) in facts.plan.resources() {
            let origin = self.model.spec.resources[facts.resource(id)].origin;
            let first = facts.live.spans[facts.resource(id)].map(|(first, _)| first);
            let holds =
                match planned.slot_reason {
                    SlotReason::Unused => {
                        planned.slot.is_none() && first.is_none() && origin == crate::Origin::Transient
                    }
                    SlotReason::Imported => matches!(origin, crate::Origin::Imported { .. }),
                    SlotReason::History => {
                        matches!(origin, crate::Origin::Previous { .. } | crate::Origin::Current { .. })
                    }
                    SlotReason::FirstOfClass => {
                        planned.slot.is_some_and(|slot| slots[slot.index()].resources[0] == id)
                    }
                    SlotReason::AllBusy(other) => {
                        let span = facts.live.spans[facts.resource(other)];
                        let busy = span.zip(first).is_some_and(|((from, to), at)| (from..=to).contains(&at));
                        let alike =
                            facts.plan.resource(other).slot.zip(planned.slot).is_some_and(|(a, b)| {
                                a != b && slots[a.index()].desc == slots[b.index()].desc
                            });
                        busy && alike
                    }
                    SlotReason::After(other) => planned.slot.is_some_and(|slot| {
                        slots[slot.index()].resources.windows(2).any(|pair| pair == [other, id])
                    }),
                };
            self.truth(holds, id, planned.slot_reason);
        }
    }
}
