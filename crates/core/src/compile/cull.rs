//! Which passes run: those whose writes reach a root.

use crate::declaration::{Declaration, Origin, PassDecl};
use crate::handle::{PassId, ResourceId};
use crate::plan::CullReason;

/// Returns, for each pass, why it does not run, or `None` if it does.
///
/// Walks backwards and keeps, for each resource, whether its contents at this point are needed. Roots are what is
/// imported or exported, and passes that are kept.
pub(super) fn cull(decl: &Declaration) -> Vec<Option<CullReason>> {
    let mut needed: Vec<bool> = decl
        .resources
        .iter()
        .map(|r| r.exported.is_some() || matches!(r.origin, Origin::Imported { .. }))
        .collect();
    let mut live = vec![false; decl.passes.len()];
    for (index, pass) in decl.passes.iter().enumerate().rev() {
        live[index] = pass.keep || writes(pass).any(|r| needed[r.index()]);
        if !live[index] {
            continue;
        }
        for access in &pass.accesses {
            if access.contents.is_some_and(|c| !c.preserves()) {
                needed[access.resource.index()] = false;
            }
        }
        for access in &pass.accesses {
            if access.contents.is_none_or(|c| c.preserves()) {
                needed[access.resource.index()] = true;
            }
        }
    }
    (0..decl.passes.len()).map(|index| (!live[index]).then(|| reason(decl, index, &live))).collect()
}

fn writes(pass: &PassDecl) -> impl Iterator<Item = ResourceId> + '_ {
    pass.accesses.iter().filter(|a| a.access.writes()).map(|a| a.resource)
}

fn reason(decl: &Declaration, index: usize, live: &[bool]) -> CullReason {
    let Some(resource) = writes(&decl.passes[index]).next() else {
        return CullReason::WritesNothing;
    };
    let later = decl.passes.iter().enumerate().skip(index + 1);
    let mut accesses =
        later.flat_map(|(other, pass)| pass.accesses.iter().map(move |access| (other, access)));
    let Some((next, access)) = accesses.find(|(_, access)| access.resource == resource) else {
        return CullReason::Unread(resource);
    };
    let overwrites = access.contents.is_some_and(|contents| !contents.preserves());
    match (overwrites, live[next]) {
        (true, true) => CullReason::Overwritten(resource, PassId(next as u32)),
        (true, false) => CullReason::Unread(resource),
        (false, _) => CullReason::OnlyCulledReaders(resource, PassId(next as u32)),
    }
}
