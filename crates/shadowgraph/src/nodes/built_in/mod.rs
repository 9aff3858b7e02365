//! The built-in kinds, a file each.

mod auto_exposure;
mod bloom;
mod clusters;
mod deferred;
mod fog;
mod forward;
mod fxaa;
mod gbuffer;
pub(crate) mod geometry;
mod hi_z;
mod overlay;
mod shadow_debug;
mod shadow_lines;
pub(crate) mod shadows;
pub(crate) mod sky;
mod ssao;
mod surfaces;
pub(crate) mod taa;
mod tonemap;
mod velocity;
pub(crate) mod view;

use super::kind::NodeKind;

pub(super) fn kinds() -> [NodeKind; 20] {
    [
        NodeKind::new::<view::ViewNode>(),
        NodeKind::new::<geometry::Geometry>(),
        NodeKind::new::<surfaces::Surfaces>(),
        NodeKind::new::<shadows::Shadows>(),
        NodeKind::new::<sky::Sky>(),
        NodeKind::new::<clusters::Clusters>(),
        NodeKind::new::<forward::Forward>(),
        NodeKind::new::<gbuffer::GBuffer>(),
        NodeKind::new::<deferred::Deferred>(),
        NodeKind::new::<ssao::Ssao>(),
        NodeKind::new::<fog::Fog>(),
        NodeKind::new::<hi_z::HiZ>(),
        NodeKind::new::<bloom::Bloom>(),
        NodeKind::new::<taa::Taa>(),
        NodeKind::new::<auto_exposure::AutoExposure>(),
        NodeKind::new::<tonemap::Tonemap>(),
        NodeKind::new::<fxaa::Fxaa>(),
        NodeKind::new::<shadow_debug::ShadowDebug>(),
        NodeKind::new::<shadow_lines::ShadowLinesNode>(),
        NodeKind::new::<overlay::Overlay>(),
    ]
}
