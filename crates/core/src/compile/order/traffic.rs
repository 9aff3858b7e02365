//! The passes that use each of the resources that take memory.

use crate::compile::csr::Csr;
use crate::declaration::{Declaration, Origin};
use crate::handle::PassId;

/// The transient resources used by passes that run.
pub(super) struct Traffic {
    /// Size of each resource; 0 if it takes no slot.
    pub(super) bytes: Vec<i64>,
    /// Whether each resource is exported.
    pub(super) exported: Vec<bool>,
    /// Resources that each pass uses, without those of size 0, each once.
    touched: Csr<u32>,
    /// Passes that use each resource, each once, in order of declaration.
    users: Csr<PassId>,
}

impl Traffic {
    /// `live` is in order of declaration.
    pub(super) fn new(decl: &Declaration, live: &[PassId]) -> Self {
        let bytes: Vec<i64> = decl.resources.iter().map(|r| bytes(r.origin, r.desc.bytes())).collect();
        let mut last = vec![None; bytes.len()];
        let mut touched = Csr::with_capacity(decl.passes.len(), decl.accesses.len());
        for &pass in live {
            touched.skip_to(pass.index());
            for access in decl.accesses(pass) {
                let resource = access.resource.index();
                if bytes[resource] != 0 && last[resource].replace(pass) != Some(pass) {
                    touched.push(resource as u32);
                }
            }
        }
        touched.skip_to(decl.passes.len());
        let of_pass = |&pass: &PassId| touched.row(pass.index()).iter().map(move |&r| (r as usize, pass));
        let users = Csr::new(bytes.len(), || live.iter().flat_map(of_pass));
        let exported = decl.resources.iter().map(|resource| resource.exported.is_some()).collect();
        Self { bytes, exported, touched, users }
    }

    pub(super) fn touched(&self, pass: PassId) -> impl Iterator<Item = usize> {
        self.touched.row(pass.index()).iter().map(|&resource| resource as usize)
    }

    pub(super) fn users(&self, resource: usize) -> &[PassId] {
        self.users.row(resource)
    }
}

fn bytes(origin: Origin, bytes: u64) -> i64 {
    if origin == Origin::Transient { i64::try_from(bytes).unwrap_or(i64::MAX) } else { 0 }
}
