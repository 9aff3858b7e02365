//! Why passes share a render pass, or why not.

use crate::access::Access;
use crate::handle::PassId;
use crate::plan::{AccessPlan, MergeReason, Plan};

impl Plan {
    /// Says why a pass was merged into the render pass before it, or why not.
    pub fn describe_merge(&self, reason: MergeReason) -> String {
        let name = |resource| self.resource(resource).name;
        match reason {
            MergeReason::First => "it is the first pass of the frame".into(),
            MergeReason::Merged => "it has the same attachments, and no hazard forbids it".into(),
            MergeReason::Off => "merging is switched off".into(),
            MergeReason::Kind(kind) => format!("it is {}", kind.with_article()),
            MergeReason::KindBefore(kind) => format!("the pass before it is {}", kind.with_article()),
            MergeReason::Attachments => "its attachments are not those of the pass before it".into(),
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
                format!("the pass before it resolves into `{}`, which ends a render pass", name(resource))
            }
        }
    }

    /// Says the same of the pass at `place` in the order, and which attachment makes the difference.
    pub(in crate::dump) fn explain_merge(&self, place: usize) -> String {
        let reason = self.merge_reasons[place];
        match (reason, place.checked_sub(1)) {
            (MergeReason::Attachments, Some(before)) => self
                .difference(self.order[place], self.order[before])
                .unwrap_or_else(|| self.describe_merge(reason)),
            _ => self.describe_merge(reason),
        }
    }

    fn difference(&self, pass: PassId, before: PassId) -> Option<String> {
        let (own, others) = (self.drawn(pass), self.drawn(before));
        let path = self.pass_path(before);
        let name = |access: &AccessPlan| self.resource(access.resource).name;
        for access in &own {
            let same = others.iter().filter(|other| other.resource == access.resource);
            let same = same.min_by_key(|other| !alike(access, other));
            match same {
                None => return Some(format!("unlike `{path}`, it {} `{}`", verb(access), name(access))),
                Some(other) if alike(access, other) => {}
                Some(other) => return Some(otherwise(access, other, name(access), &path)),
            }
        }
        let missing = others.iter().find(|other| own.iter().all(|own| own.resource != other.resource))?;
        let infinitive = if missing.access == Access::DepthRead { "test against" } else { "draw into" };
        Some(format!("unlike `{path}`, it does not {infinitive} `{}`", name(missing)))
    }

    /// What a pass draws into and tests against.
    fn drawn(&self, pass: PassId) -> Vec<AccessPlan> {
        let drawn = |a: &AccessPlan| matches!(a.access, Access::Color(_) | Access::Depth | Access::DepthRead);
        self.accesses(pass).filter(drawn).collect()
    }
}

fn alike(a: &AccessPlan, b: &AccessPlan) -> bool {
    a.access == b.access && a.region.without_rect() == b.region.without_rect()
}

fn verb(access: &AccessPlan) -> &'static str {
    if access.access == Access::DepthRead { "tests against" } else { "draws into" }
}

/// Says how a pass attaches the same texture in another way.
fn otherwise(access: &AccessPlan, other: &AccessPlan, name: &str, path: &str) -> String {
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
        _ => format!("it attaches `{name}` in another place than `{path}`"),
    }
}
