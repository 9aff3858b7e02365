//! Operations of resources whose accesses are all to the full resource: the next access decides.

use super::{declared_clear, in_render_pass, is_written_attachment, need_after_frame, zero};
use crate::declaration::{AccessDecl, Declaration, WriteMode};
use crate::handle::PassId;
use crate::plan::{AttachmentOps, LoadAction, LoadReason, StoreAction, StoreReason};

/// Walks backwards and tracks the next access to each resource.
pub(super) fn ops(
    decl: &Declaration,
    order: &[PassId],
    steps: &[(u32, u32)],
    ops: &mut [Option<AttachmentOps>],
) {
    let writers = writers(decl, order);
    let mut next: Vec<Option<(PassId, bool)>> = vec![None; decl.resources.len()];
    for &(start, end) in steps.iter().rev() {
        for position in (start..end).rev() {
            let pass = order[position as usize];
            for (access, index) in decl.accesses(pass).iter().zip(decl.access_range(pass)) {
                if is_written_attachment(access) && !decl.resource(access.resource).has_partial_accesses {
                    let store = store(decl, access, next[access.resource.index()]);
                    let load = load(decl, access, writers[index]);
                    ops[index] =
                        Some(in_render_pass((position == start, load), (position + 1 == end, store), false));
                }
            }
            for access in decl.accesses(pass) {
                next[access.resource.index()] = Some((pass, access.contents.needs()));
            }
        }
    }
}

/// Returns for each access the pass that wrote the resource before it.
fn writers(decl: &Declaration, order: &[PassId]) -> Vec<Option<PassId>> {
    let mut last: Vec<Option<PassId>> = vec![None; decl.resources.len()];
    let mut writers = vec![None; decl.accesses.len()];
    for &pass in order {
        for (access, index) in decl.accesses(pass).iter().zip(decl.access_range(pass)) {
            writers[index] = last[access.resource.index()];
            if access.contents.writes() {
                last[access.resource.index()] = Some(pass);
            }
        }
    }
    writers
}

fn load(decl: &Declaration, access: &AccessDecl, writer: Option<PassId>) -> (LoadAction, LoadReason) {
    if let Some(value) = declared_clear(decl, access) {
        return (LoadAction::Clear(value), LoadReason::Declared);
    }
    match access.contents {
        WriteMode::Preserve => {
            (LoadAction::Load, writer.map_or(LoadReason::PreservesImport, LoadReason::Preserves))
        }
        _ => (LoadAction::Clear(zero(access.access)), LoadReason::Overwritten),
    }
}

fn store(
    decl: &Declaration,
    access: &AccessDecl,
    next: Option<(PassId, bool)>,
) -> (StoreAction, StoreReason) {
    match next {
        Some((pass, true)) => (StoreAction::Store, StoreReason::NeededBy(pass)),
        Some((pass, false)) => (StoreAction::Discard, StoreReason::OverwrittenBy(pass)),
        None => match need_after_frame(decl, access.resource) {
            Some(reason) => (StoreAction::Store, reason),
            None => (StoreAction::Discard, StoreReason::LastUse),
        },
    }
}
