//! Instances that the GPU has culled, as resources of a frame.

use shadowgraph_core::{Buffer, BufferToken, Pass, Rendering};

/// The instances of some views that a pass on the GPU has culled: indirect draws, and the numbers of the visible instances.
#[derive(Clone, Debug)]
pub struct CulledInstances {
    /// The buffers of each group of [`VIEWS`](Self::VIEWS) views.
    pub groups: Vec<CulledGroup>,
}

/// The buffers of up to [`CulledInstances::VIEWS`] views.
#[derive(Clone, Debug)]
pub struct CulledGroup {
    /// The arguments of indirect draws.
    pub draws: Buffer,
    /// The numbers of the visible instances.
    pub instances: Buffer,
}

/// The buffers of one view, for the body of a pass.
#[derive(Clone, Copy, Debug)]
pub struct CulledTokens {
    /// The arguments of indirect draws.
    pub draws: BufferToken,
    /// The numbers of the visible instances.
    pub instances: BufferToken,
    /// The index of the view in its group.
    pub view: u32,
}

impl CulledInstances {
    /// The number of views that are culled together.
    pub const VIEWS: usize = 32;

    /// Declares that a pass draws a view; `None` if it does not exist.
    pub fn read_in(&self, pass: &mut Pass<'_, '_, Rendering>, view: u32) -> Option<CulledTokens> {
        let group = self.groups.get(view as usize / Self::VIEWS)?;
        Some(CulledTokens {
            draws: pass.indirect_buffer(&group.draws),
            instances: pass.storage_buffer(&group.instances),
            view: view % Self::VIEWS as u32,
        })
    }
}
