//! In which order passes run, and which hazards the order respects.

use crate::declaration::Declaration;
use crate::handle::PassId;
use crate::plan::{CullReason, Dependency, DependencyKind};

/// Returns the passes that run, in order of declaration, which versioned handles make a valid order.
pub(super) fn order(culled: &[Option<CullReason>]) -> Vec<PassId> {
    let live = culled.iter().enumerate().filter(|(_, reason)| reason.is_none());
    live.map(|(index, _)| PassId(index as u32)).collect()
}

/// The last writer of a resource and the readers since.
#[derive(Clone, Default)]
struct Tail {
    writer: Option<PassId>,
    readers: Vec<PassId>,
}

/// Returns every hazard between passes that run, each pair and resource once, in order of the later pass.
pub(super) fn dependencies(decl: &Declaration, order: &[PassId]) -> Vec<Dependency> {
    let mut tails = vec![Tail::default(); decl.resources.len()];
    let mut found = Vec::new();
    for &after in order {
        for access in &decl.pass(after).accesses {
            let tail = &mut tails[access.resource.index()];
            let mut push = |before: PassId, kind| {
                if before != after {
                    found.push(Dependency { before, after, resource: access.resource, kind });
                }
            };
            match access.contents {
                None => {
                    if let Some(writer) = tail.writer {
                        push(writer, DependencyKind::ReadAfterWrite);
                    }
                    tail.readers.push(after);
                }
                Some(contents) => {
                    if let Some(writer) = tail.writer {
                        let reads = contents.preserves();
                        push(
                            writer,
                            if reads {
                                DependencyKind::ReadAfterWrite
                            } else {
                                DependencyKind::WriteAfterWrite
                            },
                        );
                    }
                    for reader in tail.readers.drain(..) {
                        push(reader, DependencyKind::WriteAfterRead);
                    }
                    tail.writer = Some(after);
                }
            }
        }
    }
    dedup(found)
}

/// A pass that reads a resource twice depends once.
fn dedup(mut found: Vec<Dependency>) -> Vec<Dependency> {
    found.dedup();
    let mut kept: Vec<Dependency> = Vec::with_capacity(found.len());
    let mut start = 0;
    for dependency in found {
        if kept.get(start).is_some_and(|first: &Dependency| first.after != dependency.after) {
            start = kept.len();
        }
        if !kept[start..].contains(&dependency) {
            kept.push(dependency);
        }
    }
    kept
}
