//! The kinds that Shadowgraph comes with, a file each.

mod bloom;
mod clusters;
mod deferred;
mod fog;
mod forward;
mod fxaa;
mod gbuffer;
mod geometry;
mod hi_z;
mod overlay;
mod shadow_debug;
mod shadows;
mod sky;
mod ssao;
mod surfaces;
mod taa;
mod tonemap;
mod view;

pub use geometry::Geometry;
pub(crate) use shadows::Shadows;
pub(crate) use taa::Taa;
pub(crate) use view::ViewUniforms;

use super::NodeKind;

pub(super) fn kinds() -> [NodeKind; 18] {
    [
        NodeKind::of::<ViewUniforms>(),
        NodeKind::of::<geometry::Geometry>(),
        NodeKind::of::<surfaces::Surfaces>(),
        NodeKind::of::<shadows::Shadows>(),
        NodeKind::of::<clusters::Clusters>(),
        NodeKind::of::<forward::Forward>(),
        NodeKind::of::<gbuffer::GBuffer>(),
        NodeKind::of::<deferred::Deferred>(),
        NodeKind::of::<ssao::Ssao>(),
        NodeKind::of::<sky::Sky>(),
        NodeKind::of::<fog::Fog>(),
        NodeKind::of::<hi_z::HiZ>(),
        NodeKind::of::<bloom::Bloom>(),
        NodeKind::of::<Taa>(),
        NodeKind::of::<tonemap::Tonemap>(),
        NodeKind::of::<fxaa::Fxaa>(),
        NodeKind::of::<shadow_debug::ShadowDebug>(),
        NodeKind::of::<overlay::Overlay>(),
    ]
}
