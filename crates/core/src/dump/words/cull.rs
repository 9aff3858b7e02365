//! Why passes do not run, and why they do.

use super::{list, quoted};
use crate::declaration::Origin;
use crate::handle::PassId;
use crate::plan::{AccessPlan, CullReason, DependencyKind, Plan};

/// Columns of the names of readers in a sentence.
const NAMES: usize = 70;

impl Plan {
    /// Says why a pass does not run.
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

    /// Says why a pass runs: who needs what it writes.
    pub(in crate::dump) fn explain_live(&self, pass: PassId) -> String {
        if self.pass(pass).keep {
            return "it is kept, whether or not anything needs what it writes".into();
        }
        let mut needs: Vec<String> = Vec::new();
        for access in self.accesses(pass).filter(|access| access.access.writes()) {
            let name = self.resource(access.resource).name;
            let readers: Vec<String> =
                self.readers(pass, &access).into_iter().map(|p| quoted(&self.pass_path(p))).collect();
            match (readers.is_empty(), self.root_words(&access)) {
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

    /// The passes that need what this access writes.
    pub(in crate::dump) fn readers(&self, pass: PassId, access: &AccessPlan) -> Vec<PassId> {
        let needs = |other: PassId| {
            self.accesses(other).any(|a| {
                let needs = a.contents.is_none_or(|contents| contents.preserves());
                needs && a.resource == access.resource && a.region.overlaps(&access.region)
            })
        };
        let of = |d: &&crate::Dependency| {
            d.before == pass
                && d.kind == DependencyKind::ReadAfterWrite
                && d.resource == Some(access.resource)
                && needs(d.after)
        };
        self.dependencies().iter().filter(of).map(|d| d.after).collect()
    }

    fn root_words(&self, access: &AccessPlan) -> Option<&'static str> {
        let resource = self.resource(access.resource);
        match resource.origin {
            _ if resource.exported => Some("is exported"),
            Origin::Imported { .. } => Some("belongs to the caller"),
            Origin::Current { .. } => Some("is kept for the next frame"),
            Origin::Transient | Origin::Previous { .. } => None,
        }
    }
}
