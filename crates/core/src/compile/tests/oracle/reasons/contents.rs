//! Reasons why attachments load and store.

use super::super::super::frames::{AccessSpec, Cells};
use super::super::{Oracle, spec_pass};
use super::Facts;
use crate::{AttachmentOps, Contents, LoadAction, LoadReason, Origin, PassId, StoreAction, StoreReason};

impl Oracle<'_> {
    pub(super) fn contents_reasons(&mut self, facts: &Facts<'_>, position: usize) {
        let (id, pass) = (facts.plan.order()[position], facts.live.order[position]);
        for (planned, access) in facts.plan.accesses(id).zip(&self.model.spec.passes[pass].accesses) {
            if let Some(ops) = planned.ops {
                let load = self.load_reason(facts, position, access, &ops);
                self.truth(load, id, (ops.load, ops.load_reason));
                let store = self.store_reason(facts, position, access, &ops);
                self.truth(store, id, (ops.store, ops.store_reason));
            }
        }
    }

    /// Returns the position of a pass that runs and uses some of these cells as `how` says.
    fn position_of(
        &self,
        facts: &Facts<'_>,
        other: PassId,
        (resource, cells): (usize, &Cells),
        how: impl Fn(&AccessSpec) -> bool,
    ) -> Option<usize> {
        let position = facts.position(other)?;
        let touches = |(_, access, own): (usize, &AccessSpec, Cells)| {
            access.resource == resource && own.overlaps(cells) && how(access)
        };
        self.model.accesses(spec_pass(other)).any(touches).then_some(position)
    }

    fn load_reason(
        &self,
        facts: &Facts<'_>,
        position: usize,
        access: &AccessSpec,
        ops: &AttachmentOps,
    ) -> bool {
        let attachment = self.model.attachment(access);
        let subresource = access.subresource.cells(&self.model.cells[access.resource]);
        let own = (access.resource, &subresource);
        let origin = self.model.spec.resources[access.resource].origin;
        let clears = matches!(ops.load, LoadAction::Clear(_));
        let declared = matches!(access.contents, Some(Contents::Clear(_)));
        match ops.load_reason {
            LoadReason::Declared => clears && declared,
            LoadReason::Overwritten => {
                clears && access.contents == Some(Contents::Overwrite) && subresource == attachment
            }
            LoadReason::RestUnneeded => clears && subresource != attachment,
            LoadReason::Preserves(writer) => {
                let written =
                    self.position_of(facts, writer, own, |a| a.writes()).is_some_and(|at| at < position);
                ops.load == LoadAction::Load && access.contents == Some(Contents::Preserve) && written
            }
            LoadReason::PreservesImport => {
                let there = matches!(origin, Origin::Imported { defined: true });
                ops.load == LoadAction::Load && access.contents == Some(Contents::Preserve) && there
            }
            LoadReason::RestNeededBy(pass) => {
                let needs = self.position_of(facts, pass, (access.resource, &attachment), |a| a.needs());
                ops.load == LoadAction::Load && needs.is_some_and(|at| at >= position)
            }
            LoadReason::RestOutlives => {
                ops.load == LoadAction::Load
                    && subresource != attachment
                    && self.model.spec.outlives(access.resource)
            }
            LoadReason::Merged => ops.load == LoadAction::Continue,
        }
    }

    fn store_reason(
        &self,
        facts: &Facts<'_>,
        position: usize,
        access: &AccessSpec,
        ops: &AttachmentOps,
    ) -> bool {
        let together = self.model.discarded(access);
        let own = (access.resource, &together);
        let spec = self.model.spec;
        let (resource, exported) = (spec.resources[access.resource], spec.is_exported(access.resource));
        let (stores, discards) = (ops.store == StoreAction::Store, ops.store == StoreAction::Discard);
        match ops.store_reason {
            StoreReason::NeededBy(pass) => {
                stores && self.position_of(facts, pass, own, |a| a.needs()).is_some_and(|at| at > position)
            }
            StoreReason::Exported => stores && exported,
            StoreReason::Imported => stores && matches!(resource.origin, Origin::Imported { .. }),
            StoreReason::History => stores && matches!(resource.origin, Origin::Current { .. }),
            StoreReason::OverwrittenBy(pass) => {
                let overwrites = |a: &AccessSpec| a.writes() && !a.needs();
                discards && self.position_of(facts, pass, own, overwrites).is_some_and(|at| at > position)
            }
            StoreReason::LastUse => discards && !exported,
            StoreReason::Merged => ops.store == StoreAction::Continue,
        }
    }
}
