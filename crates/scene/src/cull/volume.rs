//! What a camera or a shadow tile can see.

use crate::{Aabb, ConvexVolume};
use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::cull::parts::{Parts, Settled};

#[cfg(test)]
mod tests;

/// The space that is inside all of its parts. Parts that are not needed for the shape, such as a sphere around the
/// planes, make refusals cheap: they are tested in the order sphere, cone, planes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CullVolume {
    /// A sphere; `None`: all of space.
    pub sphere: Option<BoundingSphere>,
    /// A cone; `None`: all of space.
    pub cone: Option<Cone>,
    /// Half spaces; without planes, all of space.
    pub planes: ConvexVolume,
}

/// A sphere in absolute world space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundingSphere {
    /// Its centre, metres.
    pub center_world: DVec3,
    /// Its radius, metres, 0 or above.
    pub radius_m: f64,
}

/// A cone with a flat end in absolute world space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cone {
    /// The tip, metres.
    pub tip_world: DVec3,
    /// The way it opens, unit length.
    pub axis: DVec3,
    /// Half of the angle at the tip, radians, 0 to π/2.
    pub half_angle: f64,
    /// The distance of the flat end from the tip along the axis, metres; infinite for a cone without an end.
    pub length_m: f64,
}

impl CullVolume {
    /// Tells whether the box may touch the volume. Conservative: boxes near an edge of the volume may be kept
    /// although they lie outside, but a box with a point inside all parts is never refused, save for rounding: it
    /// must be inside by 10^-14 of the coordinates. An empty box never touches. Of boxes that reach beyond 10^100 m,
    /// infinite ones too, the part up to there is tested.
    ///
    /// ```
    /// use shadowgraph_scene::{BoundingSphere, CullVolume};
    /// use glam::DVec3;
    /// use shadowgraph_scene::Aabb;
    /// let sphere = BoundingSphere { center_world: DVec3::ZERO, radius_m: 2.0 };
    /// let volume = CullVolume { sphere: Some(sphere), ..CullVolume::default() };
    /// assert!(volume.intersects(&Aabb { min: DVec3::ONE, max: DVec3::splat(9.0) }));
    /// assert!(!volume.intersects(&Aabb { min: DVec3::splat(2.0), max: DVec3::splat(9.0) }));
    /// ```
    #[must_use]
    pub fn intersects(&self, bounds: &Aabb) -> bool {
        Parts::new(self).touch(&within_space(bounds), Settled::default())
    }
}

impl From<ConvexVolume> for CullVolume {
    fn from(planes: ConvexVolume) -> Self {
        Self { planes, ..Self::default() }
    }
}

/// Where space ends, metres from the origin on each axis. Products of what is within are finite.
const EDGE_M: f64 = 1e100;

/// Cuts a box off where space ends: zero times infinity is no number. All empty boxes become one.
pub(crate) fn within_space(bounds: &Aabb) -> Aabb {
    if bounds.is_empty() {
        return Aabb::EMPTY;
    }
    let edge = DVec3::splat(EDGE_M);
    Aabb { min: bounds.min.clamp(-edge, edge), max: bounds.max.clamp(-edge, edge) }
}
