//! Load and store operations, from what passes declare of contents.

use crate::access::{Access, ClearValue, Contents};
use crate::declaration::{AccessDecl, Declaration, Origin};
use crate::handle::PassId;
use crate::plan::{AttachmentOps, LoadAction, LoadReason, StoreAction, StoreReason};

/// Returns, for each pass and access, what happens to an attachment that is written; `None` for all else.
///
/// Walks backwards and remembers the next access to each resource: it decides whether contents are still needed.
pub(super) fn ops(decl: &Declaration, order: &[PassId]) -> Vec<Vec<Option<AttachmentOps>>> {
    let mut ops: Vec<Vec<Option<AttachmentOps>>> =
        decl.passes.iter().map(|pass| vec![None; pass.accesses.len()]).collect();
    let mut next: Vec<Option<(PassId, bool)>> = vec![None; decl.resources.len()];
    for &pass in order.iter().rev() {
        let accesses = &decl.pass(pass).accesses;
        for (index, access) in accesses.iter().enumerate() {
            if access.access.is_attachment()
                && let Some(contents) = access.contents
            {
                let (load, load_reason) = load(decl, access, contents);
                let (store, store_reason) = store(decl, access, next[access.resource.index()]);
                ops[pass.index()][index] = Some(AttachmentOps { load, load_reason, store, store_reason });
            }
        }
        for access in accesses {
            let needs = access.contents.is_none_or(|contents| contents.preserves());
            next[access.resource.index()] = Some((pass, needs));
        }
    }
    ops
}

fn load(decl: &Declaration, access: &AccessDecl, contents: Contents) -> (LoadAction, LoadReason) {
    let zero =
        if access.access == Access::Depth { ClearValue::Depth(0.0) } else { ClearValue::Color([0.0; 4]) };
    match contents {
        Contents::Clear(value) => (LoadAction::Clear(value), LoadReason::Declared),
        Contents::Cover => (LoadAction::Clear(zero), LoadReason::Covered),
        Contents::Preserve => {
            let writers = &decl.resource(access.resource).writers;
            let writer = access.version.checked_sub(1).map(|made| writers[made as usize]);
            (LoadAction::Load, writer.map_or(LoadReason::PreservesImport, LoadReason::Preserves))
        }
    }
}

fn store(
    decl: &Declaration,
    access: &AccessDecl,
    next: Option<(PassId, bool)>,
) -> (StoreAction, StoreReason) {
    let resource = decl.resource(access.resource);
    match next {
        Some((pass, true)) => (StoreAction::Store, StoreReason::NeededBy(pass)),
        Some((pass, false)) => (StoreAction::Discard, StoreReason::OverwrittenBy(pass)),
        None if resource.exported.is_some() => (StoreAction::Store, StoreReason::Exported),
        None if matches!(resource.origin, Origin::Imported { .. }) => {
            (StoreAction::Store, StoreReason::Imported)
        }
        None => (StoreAction::Discard, StoreReason::LastUse),
    }
}
