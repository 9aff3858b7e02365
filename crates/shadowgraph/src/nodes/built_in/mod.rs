//! The kinds that Shadowgraph comes with, a file each.

mod forward;
mod geometry;
mod shadows;
mod surfaces;
mod tonemap;
mod view;

pub use geometry::Geometry;
pub(crate) use shadows::Shadows;

use super::NodeKind;

pub(super) fn kinds() -> [NodeKind; 6] {
    [
        NodeKind::of::<view::ViewRecords>(),
        NodeKind::of::<geometry::Geometry>(),
        NodeKind::of::<surfaces::Surfaces>(),
        NodeKind::of::<shadows::Shadows>(),
        NodeKind::of::<forward::Forward>(),
        NodeKind::of::<tonemap::Tonemap>(),
    ]
}
