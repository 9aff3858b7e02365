//! Load and store operations, from the declared contents.

mod partial;
mod whole;

use crate::access::{Access, ClearValue};
use crate::declaration::{AccessDecl, Declaration, Origin, WriteMode};
use crate::handle::{PassId, ResourceId};
use crate::plan::{AttachmentOps, LoadAction, LoadReason, StoreAction, StoreReason};

/// Returns the operations of each access that writes an attachment; `None` for other accesses.
///
/// Passes that share a render pass share its operations: the first of them loads, the last one stores.
pub(super) fn ops(decl: &Declaration, order: &[PassId], steps: &[(u32, u32)]) -> Vec<Option<AttachmentOps>> {
    let mut ops = vec![None; decl.accesses.len()];
    whole::ops(decl, order, steps, &mut ops);
    if decl.resources.iter().any(|resource| resource.has_partial_accesses) {
        partial::ops(decl, order, steps, &mut ops);
    }
    ops
}

/// Returns whether the access loads and stores an attachment.
fn is_written_attachment(access: &AccessDecl) -> bool {
    matches!(access.access, Access::Color(_) | Access::Depth)
}

/// Returns the value of a clear whose result is not used.
fn zero(access: Access) -> ClearValue {
    if access == Access::Depth { ClearValue::Depth(0.0) } else { ClearValue::Color([0.0; 4]) }
}

fn declared_clear(decl: &Declaration, access: &AccessDecl) -> Option<ClearValue> {
    match access.contents {
        WriteMode::Clear(clear) => Some(decl.clears[clear as usize]),
        WriteMode::ReadOnly | WriteMode::Overwrite | WriteMode::Preserve => None,
    }
}

/// Returns why contents are needed after the frame; `None` if they are not.
fn need_after_frame(decl: &Declaration, resource: ResourceId) -> Option<StoreReason> {
    let resource = decl.resource(resource);
    match resource.origin {
        _ if resource.exported.is_some() => Some(StoreReason::Exported),
        Origin::Imported { .. } => Some(StoreReason::Imported),
        Origin::Current { .. } => Some(StoreReason::History),
        Origin::Transient | Origin::Previous { .. } => None,
    }
}

/// Returns the operations of a pass within its render pass: only the first loads, only the last stores.
fn in_render_pass(
    (first, load): (bool, (LoadAction, LoadReason)),
    (last, store): (bool, (StoreAction, StoreReason)),
    clear_drawn: bool,
) -> AttachmentOps {
    let (load, load_reason) = if first { load } else { (LoadAction::Continue, LoadReason::Merged) };
    let (store, store_reason) = if last { store } else { (StoreAction::Continue, StoreReason::Merged) };
    AttachmentOps { load, load_reason, clear_drawn, store, store_reason }
}
