//! Every hazard is respected, and the listed dependencies are those of the hazards.

use super::super::frames::Names;
use super::{Live, Oracle, Rule, spec_pass};
use crate::{Dependency, DependencyKind, OrderPolicy, Plan};

impl Oracle<'_> {
    /// Compares every two passes that run.
    pub(super) fn ordering(&mut self, names: &Names, plan: &Plan, live: &Live) {
        let reached = self.reachable(plan);
        let mut declared = live.order.clone();
        declared.sort_unstable();
        for (at, &later) in declared.iter().enumerate() {
            for &earlier in &declared[..at] {
                if self.model.ordered(earlier, later) {
                    let kept = live.positions[earlier] < live.positions[later];
                    self.expect(kept, Rule::Hazard, || format!("p{later} runs before p{earlier}"));
                    let known = reached[later].contains(&earlier);
                    self.expect(known, Rule::Dependencies, || {
                        format!("nothing orders p{earlier} before p{later}")
                    });
                }
            }
        }
        let fixed = plan.options().order == OrderPolicy::Declared;
        self.expect(!fixed || live.order == declared, Rule::Hazard, || format!("{:?}", live.order));
        for dependency in plan.dependencies() {
            let positions = [dependency.before, dependency.after].map(|id| live.positions[spec_pass(id)]);
            let ordered = positions[0].is_some() && positions[0] < positions[1];
            let holds = ordered && self.is_true(names, dependency);
            self.expect(holds, Rule::Dependencies, || format!("{dependency:?} is not so"));
        }
    }

    /// Returns for each pass every pass that must run before it by dependencies.
    fn reachable(&self, plan: &Plan) -> Vec<Vec<usize>> {
        let mut reached: Vec<Vec<usize>> = vec![Vec::new(); self.model.spec.passes.len()];
        for later in 0..reached.len() {
            let direct = plan.dependencies().iter().filter(|d| spec_pass(d.after) == later);
            for earlier in direct.map(|d| spec_pass(d.before)).filter(|&earlier| earlier < later) {
                let mut more = reached[earlier].clone();
                more.push(earlier);
                reached[later].append(&mut more);
            }
            reached[later].sort_unstable();
            reached[later].dedup();
        }
        reached
    }

    /// Returns whether the two passes have the hazard that the dependency names.
    fn is_true(&self, names: &Names, dependency: &Dependency) -> bool {
        let (before, after) = (spec_pass(dependency.before), spec_pass(dependency.after));
        let Some(resource) = dependency.resource else {
            return dependency.kind == DependencyKind::Explicit
                && self.model.spec.passes[after].after.contains(&before);
        };
        self.model.accesses(before).any(|(_, first, own)| {
            self.model.accesses(after).any(|(_, second, other)| {
                let kind = match dependency.kind {
                    DependencyKind::ReadAfterWrite => first.writes() && second.needs(),
                    DependencyKind::WriteAfterRead => !first.writes() && second.writes(),
                    DependencyKind::WriteAfterWrite => first.writes() && second.writes(),
                    DependencyKind::Explicit => false,
                };
                let same = first.resource == second.resource && first.resource == names.resource(resource);
                kind && same && own.overlaps(&other)
            })
        })
    }
}
