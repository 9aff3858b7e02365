//! Reasons are true: what each says of its pass and resource is so.

mod contents;
mod placing;

use super::super::frames::Names;
use super::{Judge, Live, Rule, spec_pass};
use crate::{Access, Contents, CullReason, MergeReason, PassId, PassKind, Plan, ResourceId, SlotReason};

/// What the reasons are checked against.
struct Facts<'p> {
    plan: &'p Plan,
    names: &'p Names,
    live: &'p Live,
}

impl Facts<'_> {
    fn resource(&self, id: ResourceId) -> usize {
        self.names.resource(id)
    }

    /// The place in the order of a pass that runs.
    fn place(&self, id: PassId) -> Option<usize> {
        self.live.places[spec_pass(id)]
    }
}

impl Judge<'_> {
    pub(super) fn reasons(&mut self, names: &Names, plan: &Plan, live: &Live) {
        let facts = Facts { plan, names, live };
        self.cull_reasons(&facts);
        self.place_reasons(&facts);
        for place in 0..live.order.len() {
            self.merge_reason(&facts, place);
            self.contents_reasons(&facts, place);
        }
        self.slot_reasons(&facts);
    }

    fn truth(&mut self, holds: bool, subject: impl std::fmt::Debug, reason: impl std::fmt::Debug) {
        self.expect(holds, Rule::Reasons, || format!("{subject:?}: {reason:?} is not so"));
    }

    /// Whether an access of the pass touches the resource in such a way.
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
            let culled = |other: PassId| facts.place(other).is_none();
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

    fn merge_reason(&mut self, facts: &Facts<'_>, place: usize) {
        let id = facts.plan.order()[place];
        let Some(reason) = facts.plan.merging(id) else { return self.truth(false, id, "no merge reason") };
        let step = facts.live.steps[place];
        let merged = place > 0 && facts.live.steps[place - 1] == step;
        self.truth(merged == (reason == MergeReason::Merged), id, reason);
        self.truth((place == 0) == (reason == MergeReason::First), id, reason);
        if place == 0 || merged {
            return;
        }
        let before: Vec<usize> =
            (0..place).filter(|&p| facts.live.steps[p] + 1 == step).map(|p| facts.live.order[p]).collect();
        let passes = &self.model.spec.passes;
        let own = facts.live.order[place];
        let among = |other: PassId| before.contains(&spec_pass(other));
        let render = [own, before[0]].iter().all(|&pass| passes[pass].kind == PassKind::Render);
        let last = before.last().copied().unwrap_or_default();
        let holds = match reason {
            MergeReason::First | MergeReason::Merged => true,
            MergeReason::Off => !facts.plan.options().merge,
            MergeReason::Kind(kind) => passes[own].kind == kind && kind != PassKind::Render,
            MergeReason::KindBefore(kind) => passes[before[0]].kind == kind && kind != PassKind::Render,
            MergeReason::Attachments => render && !self.same_attachments(before[0], own),
            MergeReason::Reads(r, other) => {
                let r = facts.resource(r);
                among(other)
                    && self.does(spec_pass(other), r, |a| a.writes())
                    && self.does(own, r, |a| !a.writes())
            }
            MergeReason::Writes(r, other) => {
                let r = facts.resource(r);
                among(other) && self.does(spec_pass(other), r, |_| true) && self.does(own, r, |a| a.writes())
            }
            MergeReason::Clears(r) => {
                let whole = |a: &super::AccessSpec| {
                    a.part.cells(&self.model.cells[a.resource]) == self.model.attachment(a)
                };
                self.does(own, facts.resource(r), |a| {
                    matches!(a.contents, Some(Contents::Clear(_))) && whole(a)
                })
            }
            MergeReason::Resolves(r) => {
                self.does(last, facts.resource(r), |a| matches!(a.access, Access::Resolve(_)))
            }
        };
        self.truth(holds, id, reason);
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
                        planned.slot.is_some_and(|slot| slots[slot.index()].tenants[0] == id)
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
                        slots[slot.index()].tenants.windows(2).any(|pair| pair == [other, id])
                    }),
                };
            self.truth(holds, id, planned.slot_reason);
        }
    }
}
