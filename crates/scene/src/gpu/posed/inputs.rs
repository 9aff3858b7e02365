//! What the pass that deforms meshes reads and writes.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What the pass that deforms meshes reads and writes. All bytes are those of arrays of at least one element.
#[derive(Clone, Debug)]
pub struct PoseInputs<'a> {
    /// The meshes that are to be deformed.
    pub jobs: &'a [u8],
    /// The job and the first vertex of each workgroup.
    pub workgroups: &'a [u8],
    /// The number of workgroups of each dimension.
    pub dispatch: [u32; 3],
    /// The transforms of all joints.
    pub joints: &'a [u8],
    /// The weights of all morph targets.
    pub weights: &'a [u8],
    /// The vertices at rest.
    pub rest: &'a wgpu::Buffer,
    /// The influences of each vertex.
    pub influences: &'a wgpu::Buffer,
    /// The displacements of each morph target.
    pub deltas: &'a wgpu::Buffer,
    /// The vertices that the pass writes and draws read. What is not deformed, such as texture coordinates, is there already.
    pub vertices: &'a wgpu::Buffer,
    /// Tells the scene that the pass is recorded.
    pub done: PoseDone,
}

/// Tells a scene that the pass that deforms its meshes is recorded, so that the next one deforms only what changed since.
#[derive(Clone, Debug)]
pub struct PoseDone {
    pub(super) recorded: Arc<AtomicU64>,
    pub(super) revision: u64,
}

impl PoseDone {
    /// Notes that the pass is recorded, in a command buffer that is submitted before the next
    /// [update](super::super::GpuScene::update).
    pub fn note(&self) {
        self.recorded.fetch_max(self.revision, Ordering::Relaxed);
    }
}
