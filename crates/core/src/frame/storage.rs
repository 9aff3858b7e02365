//! Memory of a frame, reused from frame to frame so that declarations do not allocate.

use super::Frame;
use crate::declaration::Declaration;
use crate::error::Error;
use std::borrow::Cow;

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
    pub(crate) bodies: Vec<crate::execute::Body<'f>>,
    /// Imported object of each resource.
    #[cfg(feature = "gpu")]
    pub(crate) imports: Vec<Option<crate::pool::PhysicalResource>>,
    pub(crate) histories: Vec<crate::history::HistoryUse>,
    #[cfg(feature = "gpu")]
    pub(crate) read_backs: Vec<crate::execute::ReadBackDecl>,
    #[cfg(feature = "gpu")]
    pub(crate) shader_passes: crate::shader_pass::ShaderPasses,
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
