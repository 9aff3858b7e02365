//! The projection of a tile.

use shadowgraph_scene::{BoundingSphere, Cone, CullVolume};

use crate::ortho::OrthoFit;
use crate::spot::SpotFit;

/// The projection of a tile, in the absolute world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TileFit {
    /// A directional light's box.
    Directional(OrthoFit),
    /// The pyramid of a spot light, or of a face of a point light.
    Local(SpotFit),
}

impl TileFit {
    /// Returns the volume outside which a caster draws no texel of the tile, whatever the view shows.
    #[must_use]
    pub fn volume(&self) -> CullVolume {
        match self {
            Self::Directional(fit) => fit.cull_volume().into(),
            Self::Local(fit) => local_volume(fit),
        }
    }
}

fn local_volume(fit: &SpotFit) -> CullVolume {
    let cone = fit.cone;
    // The corners of the pyramid around the cone are outside the light, but its filter can read them.
    let widest = (fit.tan_half * std::f64::consts::SQRT_2).atan();
    CullVolume {
        sphere: Some(BoundingSphere {
            center_world: cone.position_world,
            radius_m: fit.far_m / widest.cos(),
        }),
        cone: Some(Cone {
            tip_world: cone.position_world,
            axis: cone.direction,
            half_angle: widest,
            length_m: fit.far_m,
        }),
        planes: fit.cull_volume(),
    }
}
