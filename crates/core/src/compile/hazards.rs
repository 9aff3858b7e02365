//! Dependencies between passes, from hazards and explicit orders.

use crate::declaration::{AccessDecl, Declaration};
use crate::handle::PassId;
use crate::plan::{CullReason, Dependency, DependencyKind};

/// Returns every hazard between passes that run, each once, in order of the later pass.
pub(super) fn hazards(decl: &Declaration, culled: &[Option<CullReason>]) -> Vec<Dependency> {
    let live = |pass: PassId| culled[pass.index()].is_none();
    let mut finder = Finder::new(decl);
    let mut explicit = decl.after.iter().peekable();
    for pass in decl.pass_ids() {
        while let Some(&(before, after)) = explicit.next_if(|&&(_, after)| after == pass) {
            if live(before) && live(after) {
                let kind = DependencyKind::Explicit;
                finder.found.push(Dependency { before, after, resource: None, kind });
            }
        }
        if live(pass) {
            finder.pass(decl, pass);
        }
    }
    finder.found
}

const NONE: u32 = u32::MAX;

/// Accesses so far. For each resource, the writes and the reads that nothing has overwritten since, as lists through
/// `touches`.
struct Finder {
    heads: Vec<Heads>,
    touches: Vec<Touch>,
    found: Vec<Dependency>,
}

#[derive(Clone, Copy)]
struct Heads {
    writes: u32,
    reads: u32,
    /// The last pass that used the resource.
    last: u32,
}

struct Touch {
    pass: PassId,
    /// Index of the access in the frame.
    access: u32,
    next: u32,
}

impl Finder {
    fn new(decl: &Declaration) -> Self {
        Self {
            heads: vec![Heads { writes: NONE, reads: NONE, last: NONE }; decl.resources.len()],
            touches: Vec::with_capacity(decl.accesses.len()),
            found: Vec::with_capacity(decl.accesses.len()),
        }
    }

    fn pass(&mut self, decl: &Declaration, pass: PassId) {
        let first = self.found.len();
        for index in decl.access_range(pass) {
            let again = self.heads[decl.accesses[index].resource.index()].last == pass.0;
            let first = if again { first } else { self.found.len() };
            self.access(decl, pass, index, first);
        }
    }

    /// Adds the hazards of one access; those from `first` on may already be found.
    fn access(&mut self, decl: &Declaration, pass: PassId, index: usize, first: usize) {
        let access = &decl.accesses[index];
        let Heads { writes, reads, .. } = self.heads[access.resource.index()];
        let written = access.contents.writes();
        let kind = if access.contents.needs() {
            DependencyKind::ReadAfterWrite
        } else {
            DependencyKind::WriteAfterWrite
        };
        let writes = self.walk(decl, writes, (pass, access), kind, first);
        let reads = match written {
            true => self.walk(decl, reads, (pass, access), DependencyKind::WriteAfterRead, first),
            false => reads,
        };
        let own = self.touches.len() as u32;
        let next = if written { writes } else { reads };
        self.touches.push(Touch { pass, access: index as u32, next });
        let (writes, reads) = if written { (own, reads) } else { (writes, own) };
        self.heads[access.resource.index()] = Heads { writes, reads, last: pass.0 };
    }

    /// Adds a hazard for each listed access that overlaps `access`, and returns the list without those that `access`
    /// overwrites completely.
    fn walk(
        &mut self,
        decl: &Declaration,
        head: u32,
        (after, access): (PassId, &AccessDecl),
        kind: DependencyKind,
        first: usize,
    ) -> u32 {
        let (mut kept, mut before_kept, mut at) = (head, NONE, head);
        while at != NONE {
            let Touch { pass, access: touch, next } = self.touches[at as usize];
            let touch = &decl.accesses[touch as usize];
            if pass != after && decl.overlap(touch, access) {
                let dependency = Dependency { before: pass, after, resource: Some(access.resource), kind };
                if !self.found[first..].contains(&dependency) {
                    self.found.push(dependency);
                }
            }
            if access.contents.writes() && pass != after && decl.covers(access, touch) {
                match before_kept {
                    NONE => kept = next,
                    before => self.touches[before as usize].next = next,
                }
            } else {
                before_kept = at;
            }
            at = next;
        }
        kept
    }
}
