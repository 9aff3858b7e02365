//! Targets of a pipeline.

use crate::desc::Format;
use crate::device::MAX_COLOR_ATTACHMENTS;
use arrayvec::ArrayVec;

/// The attachments that a render pipeline is made for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct PipelineTargets {
    pub(crate) colors: ArrayVec<(Format, Option<wgpu::BlendState>), MAX_COLOR_ATTACHMENTS>,
    pub(crate) depth: Option<DepthTarget>,
    pub(crate) samples: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DepthTarget {
    pub(crate) format: Format,
    pub(crate) write: bool,
    pub(crate) compare: wgpu::CompareFunction,
}
