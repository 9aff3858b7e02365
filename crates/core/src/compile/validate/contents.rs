//! Checks that every read finds defined contents.

use crate::compile::coverage::Coverage;
use crate::declaration::{AccessDecl, Declaration, Origin, WriteMode};
use crate::error::Error;
use crate::handle::{PassId, ResourceId};

/// The defined part of each resource so far.
pub(super) struct Contents(Vec<Coverage>);

impl Contents {
    pub(super) fn new(decl: &Declaration) -> Self {
        Self(decl.resources.iter().map(|r| Coverage::all_if(r.origin.defined())).collect())
    }

    /// Checks a pass, then adds what it writes.
    pub(super) fn pass(&mut self, decl: &Declaration, pass: PassId) -> Result<(), Error> {
        for access in decl.accesses(pass).iter().filter(|access| access.contents.needs()) {
            if !self.0[access.resource.index()].contains(decl.region(access)) {
                return Err(undefined(decl, pass, access));
            }
        }
        for access in decl.accesses(pass).iter().filter(|access| access.contents.writes()) {
            if matches!(decl.resource(access.resource).origin, Origin::Previous { .. }) {
                let (pass, resource) = (decl.pass_name(pass), decl.resource_path(access.resource));
                return Err(Error::PreviousWritten { pass, resource });
            }
            self.0[access.resource.index()].add(decl.region(access));
        }
        Ok(())
    }

    /// Checks that exports and histories are fully written, and exports not written again later.
    pub(super) fn exports(&self, decl: &Declaration) -> Result<(), Error> {
        for (index, resource) in decl.resources.iter().enumerate() {
            let location = match (resource.exported, resource.origin) {
                (Some(_), _) => "the export",
                (None, Origin::Current { .. }) => "the next frame",
                _ => continue,
            };
            let name = || decl.names.get(resource.name).to_owned();
            if !self.0[index].contains(None) {
                return Err(Error::UndefinedRead {
                    location: location.into(),
                    resource: name(),
                    subresource: "all".into(),
                });
            }
            if let Some(version) = resource.exported
                && version != resource.version
            {
                let writer = decl.writer(ResourceId(index as u32), version + 1);
                return Err(Error::StaleRead {
                    location: location.into(),
                    resource: name(),
                    version,
                    writer: writer.map(|pass| decl.pass_name(pass)).unwrap_or_default(),
                    latest: resource.version,
                });
            }
        }
        Ok(())
    }
}

fn undefined(decl: &Declaration, pass: PassId, access: &AccessDecl) -> Error {
    let (pass, resource) = (decl.pass_name(pass), decl.resource_path(access.resource));
    let subresource = decl.subresource(access).to_string();
    if access.contents == WriteMode::Preserve {
        Error::UndefinedPreserve { pass, resource, subresource }
    } else {
        Error::UndefinedRead { location: format!("pass {pass}"), resource, subresource }
    }
}
