//! Culling: a pass runs only if its writes reach a root.

use super::coverage::Coverage;
use super::csr::Csr;
use crate::declaration::{AccessDecl, Declaration};
use crate::handle::PassId;
use crate::plan::CullReason;

/// Returns, for each pass, why it does not run, or `None` if it does.
///
/// Walks backwards and tracks for each resource which of its contents are needed. Roots are resources that outlive the
/// frame, and kept passes.
pub(super) fn cull(decl: &Declaration) -> Vec<Option<CullReason>> {
    let roots = decl.resources.iter().map(|r| r.exported.is_some() || r.origin.outlives());
    let mut needed: Vec<Coverage> = roots.map(Coverage::all_if).collect();
    let mut live = vec![true; decl.passes.len()];
    let mut culled = 0;
    for pass in decl.pass_ids().rev() {
        let accesses = decl.accesses(pass);
        let is_needed =
            |a: &&AccessDecl| a.contents.writes() && needed[a.resource.index()].overlaps(decl.region(a));
        if !decl.pass(pass).keep && !accesses.iter().any(|a| is_needed(&a)) {
            live[pass.index()] = false;
            culled += 1;
            continue;
        }
        for access in accesses.iter().filter(|a| !a.contents.needs()) {
            needed[access.resource.index()].subtract(decl.region(access));
        }
        for access in accesses.iter().filter(|a| a.contents.needs()) {
            needed[access.resource.index()].add(decl.region(access));
        }
    }
    let mut reasons = vec![None; live.len()];
    if culled > 0 {
        let of_pass = |pass| decl.accesses(pass).iter().map(move |access| (access.resource.index(), pass));
        let users = Csr::new(decl.resources.len(), || decl.pass_ids().flat_map(of_pass));
        for pass in decl.pass_ids().filter(|pass| !live[pass.index()]) {
            reasons[pass.index()] = Some(reason(decl, pass, &live, &users));
        }
    }
    reasons
}

/// Follows the first write of a pass until all of it is overwritten or some of it is read.
fn reason(decl: &Declaration, pass: PassId, live: &[bool], users: &Csr<PassId>) -> CullReason {
    let Some(write) = decl.accesses(pass).iter().find(|a| a.contents.writes()) else {
        return CullReason::WritesNothing;
    };
    let resource = write.resource;
    let mut left = Coverage::default();
    left.add(decl.region(write));
    let users = users.row(resource.index());
    let later = users.partition_point(|user| *user <= pass);
    for &next in &users[later..] {
        let accesses = || decl.accesses(next).iter().filter(|a| a.resource == resource);
        if accesses().any(|a| a.contents.needs() && left.overlaps(decl.region(a))) {
            return CullReason::OnlyCulledReaders(resource, next);
        }
        accesses().for_each(|a| left.subtract(decl.region(a)));
        if left.is_empty() && live[next.index()] {
            return CullReason::Overwritten(resource, next);
        }
        if left.is_empty() {
            break;
        }
    }
    CullReason::Unread(resource)
}
