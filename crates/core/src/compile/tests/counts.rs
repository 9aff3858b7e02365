//! Counts of what random frames contain, so that trivial ones do not count.

use super::frames::Spec;
use super::oracle::part_is_whole;
use crate::{DependencyKind, LoadAction, MergeReason, Origin, PassKind, Plan, StoreAction, TextureUsages};
use std::cell::RefCell;
use std::collections::BTreeMap;

/// Minimum counts in 21,000 cases.
const FLOORS: [(&str, u64); 17] = [
    ("frames", 20_000),
    ("frames declared in another order", 10_000),
    ("refused frames", 300),
    ("merges", 5_000),
    ("merges refused for a hazard", 300),
    ("merges refused for a clear or resolve", 2_000),
    ("partial attachments", 15_000),
    ("drawn clears", 1_000),
    ("resolves", 2_000),
    ("loads", 15_000),
    ("discards", 25_000),
    ("transient attachments", 5_000),
    ("reuses", 3_500),
    ("histories", 1_500),
    ("culls", 40_000),
    ("reordered frames", 2_500),
    ("explicit orders", 1_500),
];

/// Counts by name.
#[derive(Default)]
pub(super) struct Counts(RefCell<BTreeMap<&'static str, u64>>);

impl Counts {
    pub(super) fn add(&self, name: &'static str, count: usize) {
        *self.0.borrow_mut().entry(name).or_default() += count as u64;
    }

    pub(super) fn count(&self, name: &str) -> u64 {
        self.0.borrow().get(name).copied().unwrap_or(0)
    }

    /// Adds the counts of one plan.
    pub(super) fn frame(&self, spec: &Spec, plan: &Plan) {
        self.add("frames", 1);
        self.passes(plan);
        self.accesses(spec, plan);
        let resources = || plan.resources().map(|(_, resource)| resource);
        let live = || resources().filter(|resource| resource.steps.is_some());
        self.add("imports", live().filter(|r| matches!(r.origin, Origin::Imported { .. })).count());
        self.add("histories", live().filter(|r| matches!(r.origin, Origin::Current { .. })).count());
        self.add("exports", resources().filter(|r| r.exported).count());
        let transient =
            |r: &crate::ResourcePlan<'_>| r.texture_usage.contains(TextureUsages::TRANSIENT_ATTACHMENT);
        self.add("transient attachments", live().filter(transient).count());
        self.add("slots", plan.slots().len());
        self.add("reuses", plan.slots().map(|slot| slot.resources.len() - 1).sum());
        let explicit = plan.dependencies().iter().filter(|d| d.kind == DependencyKind::Explicit);
        self.add("explicit orders", explicit.count());
        self.add("dependencies", plan.dependencies().len());
    }

    fn passes(&self, plan: &Plan) {
        self.add("passes", plan.pass_count());
        self.add("culls", plan.culled_count());
        self.add("reordered frames", usize::from(!plan.order().is_sorted()));
        let merges = plan.order().iter().filter_map(|&id| plan.merge_reason(id));
        for merge in merges {
            match merge {
                MergeReason::Merged => self.add("merges", 1),
                MergeReason::Reads(..) | MergeReason::Writes(..) => {
                    self.add("merges refused for a hazard", 1)
                }
                MergeReason::Clears(_) | MergeReason::Resolves(_) => {
                    self.add("merges refused for a clear or resolve", 1)
                }
                _ => {}
            }
        }
    }

    fn accesses(&self, spec: &Spec, plan: &Plan) {
        for &id in plan.order() {
            let accesses = plan.accesses(id).zip(&spec.passes[id.index()].accesses);
            for (planned, access) in accesses {
                let subresource = !part_is_whole(spec, access);
                self.add("accesses", 1);
                self.add("partial accesses", usize::from(subresource));
                self.add(
                    "partial attachments",
                    usize::from(subresource && access.attached() && access.subresource.rect.is_some()),
                );
                self.add("resolves", usize::from(matches!(access.access, crate::Access::Resolve(_))));
                let Some(ops) = planned.ops else { continue };
                self.add("drawn clears", usize::from(ops.clear_drawn));
                self.add("loads", usize::from(ops.load == LoadAction::Load));
                self.add("discards", usize::from(ops.store == StoreAction::Discard));
            }
            self.add("copies", usize::from(spec.passes[id.index()].kind == PassKind::Copy));
        }
    }

    /// Checks that the frames of as many cases are not trivial.
    pub(super) fn assert_rich(&self, cases: u32) {
        for (name, least) in FLOORS {
            assert!(
                self.count(name) * 21_000 >= least * u64::from(cases),
                "only {} {name}",
                self.count(name)
            );
        }
    }

    /// Prints every count.
    pub(super) fn print(&self, title: &str) {
        let counts = self.0.borrow();
        let words: Vec<String> = counts.iter().map(|(name, count)| format!("{count} {name}")).collect();
        super::print(&format!("{title}: {}", words.join(", ")));
    }
}
