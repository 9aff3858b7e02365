//! Reasons as sentences.

use crate::access::ClearValue;
use crate::plan::{AttachmentOps, CullReason, LoadAction, LoadReason, Plan, StoreAction, StoreReason};

impl Plan {
    /// Says why a pass does not run.
    pub fn cull_words(&self, reason: CullReason) -> String {
        match reason {
            CullReason::WritesNothing => "it writes nothing and is not kept".into(),
            CullReason::Unread(resource) => format!("nothing reads `{}`", self.resource(resource).name),
            CullReason::OnlyCulledReaders(resource, reader) => format!(
                "only culled passes need `{}`, such as `{}`",
                self.resource(resource).name,
                self.pass_path(reader)
            ),
            CullReason::Overwritten(resource, by) => format!(
                "`{}` overwrites `{}` before anything reads it",
                self.pass_path(by),
                self.resource(resource).name
            ),
        }
    }

    /// Says what an attachment holds when the pass begins, and why.
    pub fn load_words(&self, ops: &AttachmentOps) -> (String, String) {
        let action = match ops.load {
            LoadAction::Clear(ClearValue::Color(rgba)) if rgba == [rgba[0]; 4] => {
                format!("clear {}", rgba[0])
            }
            LoadAction::Clear(ClearValue::Color([r, g, b, a])) => {
                format!("clear {r:.3},{g:.3},{b:.3},{a:.3}")
            }
            LoadAction::Clear(ClearValue::Depth(depth)) => format!("clear {depth}"),
            LoadAction::Load => "load".into(),
        };
        let reason = match ops.load_reason {
            LoadReason::Declared => "the pass clears it".into(),
            LoadReason::Covered => "the pass covers it, and a clear is the cheapest begin".into(),
            LoadReason::Preserves(pass) => format!("keeps what `{}` wrote", self.pass_path(pass)),
            LoadReason::PreservesImport => "keeps what the import held".into(),
        };
        (action, reason)
    }

    /// Says what becomes of an attachment when the pass ends, and why.
    pub fn store_words(&self, ops: &AttachmentOps) -> (&'static str, String) {
        let action = match ops.store {
            StoreAction::Store => "store",
            StoreAction::Discard => "discard",
        };
        let reason = match ops.store_reason {
            StoreReason::NeededBy(pass) => format!("`{}` needs it", self.pass_path(pass)),
            StoreReason::Exported => "it is exported".into(),
            StoreReason::Imported => "it is the caller's".into(),
            StoreReason::OverwrittenBy(pass) => format!("`{}` overwrites it", self.pass_path(pass)),
            StoreReason::LastUse => "nothing reads it again".into(),
        };
        (action, reason)
    }
}

/// Bytes in the unit that suits them.
pub(super) fn bytes(bytes: u64) -> String {
    match bytes {
        0..1_024 => format!("{bytes} B"),
        1_024..1_048_576 => format!("{:.1} KiB", bytes as f64 / 1_024.0),
        _ => format!("{:.1} MiB", bytes as f64 / 1_048_576.0),
    }
}
