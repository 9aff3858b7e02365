//! Memory of a frame, reused from frame to frame so that declarations do not allocate.

use super::Frame;
use crate::declaration::Declaration;
use crate::desc::ResourceDesc;
use crate::error::Error;
use crate::handle::{NodeId, ResourceId};
use crate::history::{PriorHistory, Resize};
#[cfg(feature = "gpu")]
use crate::subresource::Subresource;
use std::borrow::Cow;
use std::sync::{Arc, Mutex, PoisonError};

/// The memory of a finished frame.
#[derive(Default)]
pub(crate) struct Storage {
    pub(crate) decl: Declaration,
    pub(crate) work: Work<'static>,
    pub(crate) errors: Vec<Error>,
}

/// Inputs of the executor besides the plan: bodies and bytes, which borrow, and the caller's objects.
#[derive(Default)]
pub(crate) struct Work<'f> {
    pub(crate) uploads: Vec<Cow<'f, [u8]>>,
    /// All uniform blocks, each at a multiple of 256 bytes.
    pub(crate) uniforms: Vec<u8>,
    /// Body of each pass.
    #[cfg(feature = "gpu")]
    pub(crate) bodies: Vec<crate::context::Body<'f>>,
    /// Imported object of each resource.
    #[cfg(feature = "gpu")]
    pub(crate) imports: Vec<Option<crate::pool::PhysicalResource>>,
    pub(crate) histories: Vec<crate::history::HistoryUse>,
    #[cfg(feature = "gpu")]
    pub(crate) read_backs: Vec<ReadBackDecl>,
    #[cfg(feature = "gpu")]
    pub(crate) shader_passes: crate::shader_pass::ShaderPasses,
}

/// A requested read-back: a copy at the end of the frame.
#[cfg(feature = "gpu")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReadBackDecl {
    pub(crate) resource: ResourceId,
    pub(crate) part: Subresource,
}

impl Work<'_> {
    /// Clears everything and changes the lifetime.
    pub(crate) fn recycle<'g>(self) -> Work<'g> {
        let Self { uploads, mut uniforms, .. } = self;
        uniforms.clear();
        Work {
            uploads: cleared(uploads),
            uniforms,
            #[cfg(feature = "gpu")]
            bodies: cleared(self.bodies),
            #[cfg(feature = "gpu")]
            imports: cleared(self.imports),
            histories: cleared(self.histories),
            #[cfg(feature = "gpu")]
            read_backs: cleared(self.read_backs),
            #[cfg(feature = "gpu")]
            shader_passes: self.shader_passes.cleared(),
        }
    }
}

/// The memory of finished frames of a graph.
pub(crate) type Spare = Arc<Mutex<Vec<Storage>>>;

/// Data of a graph that its frames share.
#[derive(Clone, Default)]
pub(crate) struct PriorState {
    pub(crate) spare: Option<Spare>,
    pub(crate) histories: Option<Arc<Vec<PriorHistory>>>,
}

impl PriorState {
    pub(crate) fn take_storage(&mut self) -> Storage {
        let spare = self.spare.as_ref();
        let storage = spare.and_then(|spare| spare.lock().unwrap_or_else(PoisonError::into_inner).pop());
        storage.unwrap_or_default()
    }

    /// Returns the memory of a frame to its graph.
    pub(crate) fn give_back(&self, storage: Storage) {
        if let Some(spare) = &self.spare {
            spare.lock().unwrap_or_else(PoisonError::into_inner).push(storage);
        }
    }

    pub(crate) fn history_valid(
        &self,
        decl: &Declaration,
        view: Option<NodeId>,
        current: ResourceId,
        resize: Resize,
    ) -> bool {
        let ResourceDesc::Texture(desc) = decl.resource(current).desc else { return false };
        self.histories
            .iter()
            .flat_map(|all| all.iter())
            .any(|prior| prior.matches(decl, view, current) && prior.fits(&desc, resize))
    }
}

impl Drop for Frame<'_> {
    /// Returns the memory to the graph.
    fn drop(&mut self) {
        let (mut decl, mut errors) = (std::mem::take(&mut self.decl), std::mem::take(&mut self.errors));
        decl.clear();
        errors.clear();
        let work = std::mem::take(&mut self.work).recycle();
        self.prior.give_back(Storage { decl, work, errors });
    }
}

/// Clears a vector and reuses its memory for a vector of the same layout: collecting in place keeps the allocation,
/// and a type that differs only in lifetimes has the same layout.
fn cleared<A, B>(mut vector: Vec<A>) -> Vec<B> {
    vector.clear();
    vector.into_iter().filter_map(|_| None).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recycled_memory_is_reused_for_another_lifetime() {
        let bytes = [1u8, 2, 3];
        let mut work = Work::default();
        work.uploads.extend((0..40).map(|_| Cow::Borrowed(&bytes[..])));
        let (capacity, address) = (work.uploads.capacity(), work.uploads.as_ptr().addr());
        let next: Work<'static> = work.recycle();
        assert!(next.uploads.is_empty());
        assert_eq!((next.uploads.capacity(), next.uploads.as_ptr().addr()), (capacity, address));
    }
}
