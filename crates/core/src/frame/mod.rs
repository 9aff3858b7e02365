//! Declaration of a frame.

mod compose;
mod history;
mod resources;
mod storage;

pub use history::History;
#[cfg(feature = "gpu")]
pub(crate) use storage::ReadBackDecl;
pub(crate) use storage::{PriorState, Spare, Storage, Work};

use crate::access::{Access, Contents};
use crate::declaration::{
    ALL_OF_RESOURCE, AccessDecl, Declaration, Options, PassDecl, PassKind, SubresourceDecl, WriteMode,
};
use crate::error::Error;
use crate::handle::{NodeId, PassId, Token, Version};
use crate::name::Name;
use crate::pass_name::PassName;
use crate::subresource::Subresource;
use std::any::{Any, TypeId};
use std::collections::HashMap;
use std::panic::Location;
use std::sync::atomic::{AtomicU64, Ordering};

/// A frame: the passes and resources declared so far.
///
/// [`Graph::frame`](crate::Graph::frame) creates one that reuses the memory of earlier frames; `Frame::new` creates a
/// frame without a graph. `'f` is the lifetime of what pass bodies and uploads borrow.
pub struct Frame<'f> {
    id: u64,
    pub(crate) decl: Declaration,
    pub(crate) work: Work<'f>,
    errors: Vec<Error>,
    node: Option<NodeId>,
    /// Innermost view around the current declarations.
    view: Option<NodeId>,
    published: HashMap<TypeId, Box<dyn Any + Send>>,
    prior: PriorState,
}

impl Default for Frame<'_> {
    fn default() -> Self {
        Self::new()
    }
}

impl<'f> Frame<'f> {
    /// Starts an empty frame.
    pub fn new() -> Self {
        Self::with_prior_state(PriorState::default())
    }

    pub(crate) fn with_prior_state(mut prior: PriorState) -> Self {
        // Distinguishes handles of different frames; plans do not contain it.
        static FRAMES: AtomicU64 = AtomicU64::new(0);
        let Storage { decl, work, errors } = prior.take_storage();
        Self {
            id: FRAMES.fetch_add(1, Ordering::Relaxed),
            decl,
            work: work.recycle(),
            errors,
            node: None,
            view: None,
            published: HashMap::new(),
            prior,
        }
    }

    /// Sets what the compiler may do with this frame.
    pub fn set_options(&mut self, options: Options) {
        self.decl.options = options;
    }

    /// Executes passes in the order of declaration.
    pub fn fix_order(&mut self) {
        self.decl.options.order = crate::declaration::OrderPolicy::Declared;
    }

    /// Returns the first error of the declaration.
    pub(crate) fn check(&mut self) -> Result<(), Error> {
        if self.errors.is_empty() { Ok(()) } else { Err(self.errors.swap_remove(0)) }
    }

    /// Adds an error of the declaration.
    #[cfg(feature = "gpu")]
    pub(crate) fn report_error(&mut self, error: Error) {
        self.errors.push(error);
    }

    #[cfg(any(feature = "gpu", test))]
    pub(crate) fn id(&self) -> u64 {
        self.id
    }

    /// Adds a pass without accesses.
    #[track_caller]
    pub(crate) fn add_pass(&mut self, name: impl Name, kind: PassKind) -> PassId {
        let id = PassId(self.decl.passes.len() as u32);
        let name = self.decl.names.push(name);
        let (accesses, copies) = (self.decl.accesses.len() as u32, self.decl.copies.len() as u32);
        self.decl.passes.push(PassDecl {
            name,
            node: self.node,
            kind,
            keep: false,
            accesses: (accesses, accesses),
            copies: (copies, copies),
            attachment: None,
        });
        self.decl.places.0.push(Location::caller());
        #[cfg(feature = "gpu")]
        self.work.bodies.push(crate::context::Body::None);
        id
    }

    /// Declares a read of `subresource`, which is reset.
    pub(crate) fn declare_read(
        &mut self,
        pass: PassId,
        version: Version,
        access: Access,
        subresource: &mut Option<Subresource>,
    ) -> Token {
        if version.frame != self.id {
            *subresource = None;
            return self.invalid_token(pass, version);
        }
        if self.is_stale(version) {
            self.report_stale_read(pass, version);
        }
        self.add_access(pass, version, access, WriteMode::ReadOnly, subresource)
    }

    /// Declares a write to `subresource`, which is reset.
    pub(crate) fn declare_write(
        &mut self,
        pass: PassId,
        version: &mut Version,
        access: Access,
        contents: Contents,
        subresource: &mut Option<Subresource>,
    ) -> Token {
        if version.frame != self.id {
            *subresource = None;
            return self.invalid_token(pass, *version);
        }
        if self.is_stale(*version) {
            self.report_two_writers(pass, *version);
        }
        let mode = self.write_mode(contents);
        let token = self.add_access(pass, *version, access, mode, subresource);
        let resource = &mut self.decl.resources[version.resource.index()];
        resource.version += 1;
        version.version = resource.version;
        token
    }

    fn write_mode(&mut self, contents: Contents) -> WriteMode {
        match contents {
            Contents::Overwrite => WriteMode::Overwrite,
            Contents::Preserve => WriteMode::Preserve,
            Contents::Clear(value) => {
                let clears = &mut self.decl.clears;
                // Frames clear to few values, most often to a recent one.
                let known = clears.iter().rev().take(4).position(|&v| v == value);
                let index = known.map_or(clears.len(), |back| clears.len() - 1 - back);
                if known.is_none() {
                    clears.push(value);
                }
                WriteMode::Clear(index as u32)
            }
        }
    }

    #[cold]
    fn report_stale_read(&mut self, pass: PassId, version: Version) {
        let location = format!("pass {}", self.decl.pass_name(pass));
        let error = self.stale_read(location, version);
        self.errors.push(error);
    }

    #[cold]
    fn report_two_writers(&mut self, pass: PassId, version: Version) {
        self.errors.push(Error::TwoWriters {
            pass: self.decl.pass_name(pass),
            resource: self.decl.resource_path(version.resource),
            version: version.version,
            writer: self.writer_after(version),
        });
    }

    /// Returns a token for a handle of another frame. No pass resolves it.
    #[cold]
    fn invalid_token(&mut self, pass: PassId, version: Version) -> Token {
        let location = format!("pass {}", self.decl.pass_name(pass));
        self.errors.push(Error::ForeignHandle { location });
        Token::new(version.frame, u32::MAX)
    }

    pub(crate) fn pass_mut(&mut self, pass: PassId) -> &mut PassDecl {
        &mut self.decl.passes[pass.index()]
    }

    /// Declares an explicit order of two passes; see [`Pass::after`].
    pub(crate) fn declare_after(&mut self, pass: PassId, other: PassId) {
        if other < pass {
            self.decl.after.push((other, pass));
        } else {
            self.errors.push(Error::Order { pass: self.decl.pass_name(pass), other: other.0 });
        }
    }

    #[inline(always)]
    fn add_access(
        &mut self,
        pass: PassId,
        version: Version,
        access: Access,
        contents: WriteMode,
        subresource: &mut Option<Subresource>,
    ) -> Token {
        let subresource = match *subresource {
            None => ALL_OF_RESOURCE,
            Some(own) => {
                *subresource = None;
                self.add_part(pass, version, own)
            }
        };
        let Version { resource, version, .. } = version;
        self.decl.accesses.push(AccessDecl { resource, access, contents, version, subresource });
        let end = self.decl.accesses.len() as u32;
        let declared = self.pass_mut(pass);
        declared.accesses.1 = end;
        if declared.attachment.is_none() && access.is_attachment() {
            declared.attachment = Some(resource);
        }
        Token::new(self.id, end - 1)
    }

    /// Adds a subresource, unless it is the full resource.
    #[inline(never)]
    fn add_part(&mut self, pass: PassId, version: Version, subresource: Subresource) -> u32 {
        let resource = &mut self.decl.resources[version.resource.index()];
        if let Some(problem) = subresource.problem(&resource.desc) {
            let error = Error::InvalidSubresource {
                pass: self.decl.pass_name(pass),
                resource: self.decl.resource_path(version.resource),
                subresource: subresource.to_string(),
                problem,
            };
            self.errors.push(error);
            return ALL_OF_RESOURCE;
        }
        let Some(region) = subresource.region(&resource.desc) else { return ALL_OF_RESOURCE };
        resource.has_partial_accesses = true;
        self.decl.subresources.push(SubresourceDecl { subresource, region });
        self.decl.subresources.len() as u32 - 1
    }

    fn is_stale(&self, version: Version) -> bool {
        version.version != self.decl.resource(version.resource).version
    }

    fn stale_read(&self, location: String, version: Version) -> Error {
        Error::StaleRead {
            location,
            resource: self.decl.resource_path(version.resource),
            version: version.version,
            writer: self.writer_after(version),
            latest: self.decl.resource(version.resource).version,
        }
    }

    /// Returns the pass that wrote the next version.
    fn writer_after(&self, version: Version) -> PassName {
        let writer = self.decl.writer(version.resource, version.version + 1);
        writer.map(|pass| self.decl.pass_name(pass)).unwrap_or_default()
    }
}
