//! The kinds that Shadowgraph comes with, a file each.

mod clusters;
mod deferred;
mod forward;
mod gbuffer;
mod geometry;
mod shadows;
mod surfaces;
mod tonemap;
mod view;

pub use geometry::Geometry;
pub(crate) use shadows::Shadows;

use super::NodeKind;

pub(super) fn kinds() -> [NodeKind; 9] {
    [
        NodeKind::of::<view::ViewRecords>(),
        NodeKind::of::<geometry::Geometry>(),
        NodeKind::of::<surfaces::Surfaces>(),
        NodeKind::of::<shadows::Shadows>(),
        NodeKind::of::<clusters::Clusters>(),
        NodeKind::of::<forward::Forward>(),
        NodeKind::of::<gbuffer::GBuffer>(),
        NodeKind::of::<deferred::Deferred>(),
        NodeKind::of::<tonemap::Tonemap>(),
    ]
}
