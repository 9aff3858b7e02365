//! Positions of passes, and why they run or do not, where they are in the order, and which render pass they share.

use super::{bytes, list, quoted};
use crate::access::Access;
use crate::declaration::Origin;
use crate::handle::PassId;
use crate::plan::{AccessPlan, CullReason, Dependency, DependencyKind, MergeReason, OrderReason, Plan};

/// Width of the names of readers in a sentence, in columns.
const NAMES: usize = 70;

impl Plan {
    /// Describes why a pass does not run.
    pub fn describe_cull(&self, reason: CullReason) -> String {
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

    /// Explains why a pass runs: which passes need what it writes.
    pub fn explain_live(&self, pass: PassId) -> String {
        if self.pass(pass).keep {
            return "it is kept even if nothing needs what it writes".into();
        }
        let mut needs: Vec<String> = Vec::new();
        for access in self.accesses(pass).filter(|access| access.access.writes()) {
            let name = self.resource(access.resource).name;
            let readers: Vec<String> =
                self.readers(pass, &access).into_iter().map(|p| quoted(&self.pass_path(p))).collect();
            match (readers.is_empty(), self.root_reason(&access)) {
                (false, _) => {
                    let verb = if readers.len() > 1 { "need" } else { "needs" };
                    needs.push(format!("{} {verb} `{name}`", list(&readers, NAMES)));
                }
                (true, Some(root)) => needs.push(format!("`{name}` {root}")),
                (true, None) => {}
            }
        }
        needs.dedup();
        if needs.is_empty() { "what it writes is needed".into() } else { needs.join("; ") }
    }

    /// Returns the passes that need what this access writes.
    pub(in crate::dump) fn readers(&self, pass: PassId, access: &AccessPlan) -> Vec<PassId> {
        let needs = |other: PassId| {
            self.accesses(other).any(|a| {
                let needs = a.contents.is_none_or(|contents| contents.preserves());
                needs && a.resource == access.resource && a.region.overlaps(&access.region)
            })
        };
        let of = |d: &&Dependency| {
            d.before == pass
                && d.kind == DependencyKind::ReadAfterWrite
                && d.resource == Some(access.resource)
                && needs(d.after)
        };
        self.dependencies().iter().filter(of).map(|d| d.after).collect()
    }

    fn root_reason(&self, access: &AccessPlan) -> Option<&'static str> {
        let resource = self.resource(access.resource);
        match resource.origin {
            _ if resource.exported => Some("is exported"),
            Origin::Imported { .. } => Some("belongs to the caller"),
            Origin::Current { .. } => Some("is kept for the next frame"),
            Origin::Transient | Origin::Previous { .. } => None,
        }
    }

    /// Describes why a pass was scheduled at its position. A pass is ready when everything that it depends on has run.
    pub fn describe_order(&self, reason: OrderReason) -> String {
        match reason {
            OrderReason::Fixed => "the frame fixes the order of declaration".into(),
            OrderReason::OnlyReady => "it was the only ready pass".into(),
            OrderReason::ContinuesRenderPass => {
                "of the ready passes, it continues the open render pass".into()
            }
            OrderReason::FreesMemory(0) => "of the ready passes, only this one needs no more memory".into(),
            OrderReason::FreesMemory(freed) => {
                let verb = if freed > 0 { "frees the most" } else { "takes the least" };
                format!("of the ready passes, it {verb} memory: {}", bytes(freed.unsigned_abs()))
            }
            OrderReason::DeclaredFirst => "the first declared of the ready passes best for memory".into(),
            OrderReason::BackwardsNeedsLess => "choosing from last to first needs the least memory".into(),
            OrderReason::DeclarationNeedsLess => {
                "declaration order; choosing by memory would need more".into()
            }
        }
    }

    /// Explains why one pass must follow another.
    pub fn explain_dependency(&self, dependency: &Dependency) -> String {
        let (before, after) = (self.pass_path(dependency.before), self.pass_path(dependency.after));
        let name = dependency.resource.map_or("", |resource| self.resource(resource).name);
        match dependency.kind {
            DependencyKind::ReadAfterWrite => format!("`{after}` needs what `{before}` wrote to `{name}`"),
            DependencyKind::WriteAfterRead => {
                format!("`{after}` overwrites `{name}`, which `{before}` reads")
            }
            DependencyKind::WriteAfterWrite => {
                format!("`{after}` overwrites what `{before}` wrote to `{name}`")
            }
            DependencyKind::Explicit => format!("`{after}` was declared to run after `{before}`"),
        }
    }

    /// Describes why a pass was merged into the render pass before it, or why not.
    pub fn describe_merge(&self, reason: MergeReason) -> String {
        let name = |resource| self.resource(resource).name;
        match reason {
            MergeReason::First => "it is the first pass of the frame".into(),
            MergeReason::Merged => "it has the same attachments, and no hazard forbids it".into(),
            MergeReason::Off => "merging is switched off".into(),
            MergeReason::Kind(kind) => format!("it is {}", kind.with_article()),
            MergeReason::KindBefore(kind) => format!("the previous pass is {}", kind.with_article()),
            MergeReason::Attachments => "its attachments differ from those of the previous pass".into(),
            MergeReason::Reads(resource, pass) => {
                format!("it reads `{}`, which `{}` writes", name(resource), self.pass_path(pass))
            }
            MergeReason::Writes(resource, pass) => {
                format!("it writes `{}`, which `{}` touches", name(resource), self.pass_path(pass))
            }
            MergeReason::Clears(resource) => {
                format!("it clears all of `{}`, which is free when a render pass begins", name(resource))
            }
            MergeReason::Resolves(resource) => {
                format!("the previous pass resolves into `{}`, which ends a render pass", name(resource))
            }
        }
    }

    /// Explains the merge decision of the pass at `index` in the order, and names the attachment that differs.
    ///
    /// # Panics
    /// If fewer passes run.
    pub fn explain_merge(&self, index: usize) -> String {
        let reason = self.merge_reasons[index];
        match (reason, index.checked_sub(1)) {
            (MergeReason::Attachments, Some(before)) => self
                .attachment_difference(self.order[index], self.order[before])
                .unwrap_or_else(|| self.describe_merge(reason)),
            _ => self.describe_merge(reason),
        }
    }

    fn attachment_difference(&self, pass: PassId, before: PassId) -> Option<String> {
        let (own, others) = (self.attachments(pass), self.attachments(before));
        let path = self.pass_path(before);
        let name = |access: &AccessPlan| self.resource(access.resource).name;
        for access in &own {
            let same = others.iter().filter(|other| other.resource == access.resource);
            let same = same.min_by_key(|other| !same_attachment(access, other));
            match same {
                None => {
                    return Some(format!(
                        "unlike `{path}`, it {} `{}`",
                        attachment_verb(access),
                        name(access)
                    ));
                }
                Some(other) if same_attachment(access, other) => {}
                Some(other) => return Some(describe_difference(access, other, name(access), &path)),
            }
        }
        let missing = others.iter().find(|other| own.iter().all(|own| own.resource != other.resource))?;
        let infinitive = if missing.access == Access::DepthRead { "test against" } else { "draw into" };
        Some(format!("unlike `{path}`, it does not {infinitive} `{}`", name(missing)))
    }

    /// Returns the attachments of a pass, without resolve targets.
    fn attachments(&self, pass: PassId) -> Vec<AccessPlan> {
        let drawn = |a: &AccessPlan| matches!(a.access, Access::Color(_) | Access::Depth | Access::DepthRead);
        self.accesses(pass).filter(drawn).collect()
    }
}

fn same_attachment(a: &AccessPlan, b: &AccessPlan) -> bool {
    a.access == b.access && a.region.without_rect() == b.region.without_rect()
}

fn attachment_verb(access: &AccessPlan) -> &'static str {
    if access.access == Access::DepthRead { "tests against" } else { "draws into" }
}

/// Describes how two passes attach the same texture differently.
fn describe_difference(access: &AccessPlan, other: &AccessPlan, name: &str, path: &str) -> String {
    match (access.access, other.access) {
        (Access::DepthRead, Access::Depth) => {
            format!("it only tests against `{name}`, which `{path}` writes")
        }
        (Access::Depth, Access::DepthRead) => {
            format!("it writes `{name}`, which `{path}` only tests against")
        }
        (a, b) if a == b => {
            let (own, others) = (access.subresource.to_string(), other.subresource.to_string());
            format!("it draws into {own} of `{name}`, `{path}` into {others}")
        }
        _ => format!("it attaches `{name}` at another index than `{path}`"),
    }
}

/// Positions of all passes of a plan.
#[derive(Clone, Debug)]
pub struct Positions(Vec<Option<Position>>);

/// Position of a pass in the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Index among all passes that run.
    pub order: usize,
    /// Index of its step.
    pub step: usize,
    /// Index among the passes of the step.
    pub within: usize,
    /// Number of passes of the step.
    pub passes: usize,
}

impl Positions {
    /// Finds the positions of all passes.
    pub fn new(plan: &Plan) -> Self {
        let mut positions = vec![None; plan.pass_count()];
        let mut order = 0;
        for (step, passes) in plan.steps().enumerate() {
            for (within, pass) in passes.passes.iter().enumerate() {
                positions[pass.index()] = Some(Position { order, step, within, passes: passes.passes.len() });
                order += 1;
            }
        }
        Self(positions)
    }

    /// Returns the position of a pass of the plan; `None` if the pass is culled.
    ///
    /// # Panics
    /// If the id is out of range for the plan.
    pub fn get(&self, pass: PassId) -> Option<Position> {
        self.0[pass.index()]
    }
}
