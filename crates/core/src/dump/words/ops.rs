//! Why attachments are loaded, cleared, stored and discarded.

use super::clear;
use crate::access::{Access, Contents};
use crate::handle::PassId;
use crate::plan::{AccessPlan, AttachmentOps, LoadAction, LoadReason, Plan, StoreAction, StoreReason};

impl Plan {
    /// Says what an attachment holds when the pass begins, and why.
    pub fn describe_load(&self, ops: &AttachmentOps) -> (String, String) {
        let action = match ops.load {
            LoadAction::Clear(value) => clear(value),
            LoadAction::Load => "load".into(),
            LoadAction::Continue => "continue".into(),
        };
        let reason = match ops.load_reason {
            LoadReason::Declared => "the pass clears it".into(),
            LoadReason::Overwritten => "the pass covers it, and clearing costs less than loading".into(),
            LoadReason::Preserves(pass) => format!("the pass keeps what `{}` wrote", self.pass_path(pass)),
            LoadReason::PreservesImport => "the pass keeps what was there when the frame began".into(),
            LoadReason::RestUnneeded => {
                "nothing needs what the rest held, and clearing costs less than loading".into()
            }
            LoadReason::RestNeededBy(pass) => format!("`{}` needs the rest of it", self.pass_path(pass)),
            LoadReason::RestOutlives => "the rest of it is needed after the frame".into(),
            LoadReason::Merged => "the render pass goes on from the pass before".into(),
        };
        (action, reason)
    }

    /// Says what becomes of an attachment when the pass ends, and why.
    pub fn describe_store(&self, ops: &AttachmentOps) -> (&'static str, String) {
        let action = match ops.store {
            StoreAction::Store => "store",
            StoreAction::Discard => "discard",
            StoreAction::Continue => "continue",
        };
        let reason = match ops.store_reason {
            StoreReason::NeededBy(pass) => format!("`{}` needs it", self.pass_path(pass)),
            StoreReason::Exported => "it is exported".into(),
            StoreReason::Imported => "it belongs to the caller".into(),
            StoreReason::History => "the next frame reads it as history".into(),
            StoreReason::Merged => "the render pass goes on with the next pass".into(),
            StoreReason::OverwrittenBy(pass) => {
                format!("`{}` overwrites it before anything reads it", self.pass_path(pass))
            }
            StoreReason::LastUse => "nothing reads it after this".into(),
        };
        (action, reason)
    }

    /// [`describe_load`](Self::describe_load) of an access, which may be of a part.
    pub(in crate::dump) fn explain_load(&self, access: &AccessPlan, ops: &AttachmentOps) -> (String, String) {
        let (action, reason) = self.describe_load(ops);
        let in_part = access.region != access.region.without_rect();
        match ops.load_reason {
            LoadReason::Declared if in_part => {
                (action, "the pass clears its part, and nothing needs what the rest held".into())
            }
            LoadReason::Merged if self.explain_done_clear(access, ops).is_some() => {
                (action, "the render pass goes on from the pass before, and began with this clear".into())
            }
            _ => (action, reason),
        }
    }

    /// [`describe_store`](Self::describe_store) of an access, which may be resolved.
    pub(in crate::dump) fn explain_store(
        &self,
        pass: PassId,
        access: &AccessPlan,
        ops: &AttachmentOps,
    ) -> (&'static str, String) {
        let (action, reason) = self.describe_store(ops);
        match (ops.store_reason, access.access) {
            (StoreReason::LastUse, Access::Color(index))
                if self.accesses(pass).any(|a| a.access == Access::Resolve(index)) =>
            {
                (action, "it is resolved, and nothing reads the samples after this".into())
            }
            _ => (action, reason),
        }
    }

    /// Says by what a pass inside a render pass got its clear where nothing is drawn for it.
    pub(in crate::dump) fn explain_done_clear(
        &self,
        access: &AccessPlan,
        ops: &AttachmentOps,
    ) -> Option<(String, &'static str)> {
        let Some(Contents::Clear(value)) = access.contents else { return None };
        let done = ops.load == LoadAction::Continue && !ops.clear_drawn;
        done.then(|| (clear(value), "the render pass began with it"))
    }

    /// Says what the graph draws before the pass, in place of a load operation, and why.
    pub(in crate::dump) fn explain_drawn_clear(
        &self,
        access: &AccessPlan,
        ops: &AttachmentOps,
    ) -> Option<(String, String)> {
        let Some(Contents::Clear(value)) = access.contents else { return None };
        let why = match ops.load {
            LoadAction::Continue => "the render pass is under way, so no load operation can clear",
            _ => "a load operation would clear all of the attachment",
        };
        ops.clear_drawn.then(|| (format!("{}, drawn", clear(value)), why.into()))
    }
}
