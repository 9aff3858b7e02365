//! What accesses are, and where what they find comes from.

use super::{list, quoted};
use crate::access::{Access, Contents};
use crate::declaration::{CopyOp, Origin, PassKind};
use crate::handle::PassId;
use crate::plan::{AccessPlan, Dependency, DependencyKind, Plan};
use crate::subresource::RegionSet;

impl PassKind {
    /// `a render pass`.
    pub(in crate::dump) fn with_article(self) -> &'static str {
        match self {
            Self::Render => "a render pass",
            Self::Compute => "a compute pass",
            Self::Copy => "a copy pass",
            Self::Encoder => "an encoder pass",
        }
    }
}

impl Access {
    /// The access in two words at most, with the number of a colour attachment.
    pub(in crate::dump) fn label(self) -> String {
        match self {
            Self::Color(index) => format!("color {index}"),
            Self::Resolve(index) => format!("resolve {index}"),
            other => other.as_str().into(),
        }
    }
}

/// What a pass does with a resource: the words before its name and those after it.
pub(in crate::dump) fn verb(access: Access) -> (&'static str, String) {
    let (verb, role) = match access {
        Access::Color(index) => return ("draws into", format!(" as colour attachment {index}")),
        Access::Resolve(index) => return ("resolves into", format!(" from colour attachment {index}")),
        Access::Depth => ("draws into", " as depth attachment"),
        Access::DepthRead => ("tests against", " as depth attachment"),
        Access::Sampled => ("samples", ""),
        Access::StorageRead => ("reads", " as storage"),
        Access::StorageWrite => ("writes", " as storage"),
        Access::Uniform => ("reads", " as uniform buffer"),
        Access::Vertex => ("reads", " as vertex buffer"),
        Access::Index => ("reads", " as index buffer"),
        Access::Indirect => ("reads", " as indirect arguments"),
        Access::CopySource => ("copies from", ""),
        Access::CopyTarget => ("copies into", ""),
    };
    (verb, role.into())
}

impl Plan {
    /// What the pass waits for. Dependencies are in order of the later pass.
    pub(in crate::dump) fn waits_for(&self, pass: PassId) -> &[Dependency] {
        let all = self.dependencies();
        let start = all.partition_point(|dependency| dependency.after < pass);
        let end = all.partition_point(|dependency| dependency.after <= pass);
        &all[start..end]
    }

    /// The passes that wrote what the access finds.
    pub(in crate::dump) fn writers(&self, pass: PassId, access: &AccessPlan) -> Vec<PassId> {
        let writes = |other: PassId| {
            self.accesses(other).any(|a| {
                a.access.writes() && a.resource == access.resource && a.region.overlaps(&access.region)
            })
        };
        let of = |d: &&Dependency| {
            d.kind == DependencyKind::ReadAfterWrite
                && d.resource == Some(access.resource)
                && writes(d.before)
        };
        let mut writers: Vec<PassId> = self.waits_for(pass).iter().filter(of).map(|d| d.before).collect();
        writers.sort();
        writers
    }

    /// Who wrote what the access finds, in about so many columns.
    pub(in crate::dump) fn source_words(&self, pass: PassId, access: &AccessPlan, columns: usize) -> String {
        let writers = self.writers(pass, access);
        let mut left = RegionSet::from_region(access.region);
        for written in writers.iter().flat_map(|&writer| self.accesses(writer)) {
            if written.access.writes() && written.resource == access.resource {
                left.subtract(&written.region);
            }
        }
        let before = match self.resource(access.resource).origin {
            Origin::Imported { .. } => Some("the caller"),
            Origin::Previous { .. } => Some("the frame before"),
            Origin::Transient | Origin::Current { .. } => None,
        };
        let before = before.filter(|_| !left.is_empty()).map(String::from);
        let sources = before.into_iter().chain(writers.iter().map(|&writer| quoted(&self.pass_path(writer))));
        list(&sources.collect::<Vec<_>>(), columns)
    }

    /// What an access does beside what its name says: where its contents come from, or what becomes of the old ones.
    pub(in crate::dump) fn access_note(&self, pass: PassId, access: &AccessPlan, columns: usize) -> String {
        let uploaded =
            |op: &CopyOp| matches!(op, CopyOp::Upload { target, .. } if *target == access.resource);
        match (access.access, access.contents) {
            (_, None) => match self.source_words(pass, access, columns) {
                source if source.is_empty() => source,
                source => format!("from {source}"),
            },
            (Access::Resolve(index), _) => {
                let of_index = |a: &AccessPlan| a.access == Access::Color(index);
                let source = self.accesses(pass).find(of_index);
                let name = source.map_or("", |source| self.resource(source.resource).name);
                format!("averages the samples of `{name}`")
            }
            _ if self.pass(pass).copies.iter().any(uploaded) => "uploaded by the CPU".into(),
            (_, Some(Contents::Preserve)) if access.ops.is_none() => {
                match self.source_words(pass, access, columns) {
                    source if source.is_empty() => "keeps what was there".into(),
                    source => format!("keeps what {source} wrote"),
                }
            }
            (_, Some(Contents::Overwrite)) if access.ops.is_none() => "covers it".into(),
            _ => String::new(),
        }
    }
}
