//! Convex volumes: the space that a camera or a shadow tile can see.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::bounds::{Aabb, ConvexVolume, Plane};
use crate::cull::shapes::{BoundingSphere, Cone, ConvexShape, PreparedCone};

#[cfg(test)]
mod tests;

/// The intersection of a sphere, a cone and half spaces. Shapes that do not change the volume, such as a sphere around
/// the planes, make rejection cheap: they are tested in the order sphere, cone, planes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CullVolume {
    /// A sphere; `None`: all of space.
    pub sphere: Option<BoundingSphere>,
    /// A cone; `None`: all of space.
    pub cone: Option<Cone>,
    /// Half spaces; without planes, all of space.
    pub planes: ConvexVolume,
}

impl CullVolume {
    /// Returns whether the box may intersect the volume. Conservative: boxes near an edge of the volume may be kept
    /// although they lie outside, but a box with a point inside all shapes is never rejected, within rounding: the point
    /// must be inside by 10^-14 of the coordinates. An empty box never intersects. Boxes that extend beyond 10^100 m,
    /// infinite ones included, are clipped there.
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
        PreparedVolume::new(self).intersects(&clip_to_space(bounds), ShapeMask::default())
    }
}

impl From<ConvexVolume> for CullVolume {
    fn from(planes: ConvexVolume) -> Self {
        Self { planes, ..Self::default() }
    }
}

/// The largest coordinate of clipped boxes, metres. Products of coordinates up to it are finite.
const MAX_COORDINATE_M: f64 = 1e100;

/// Clips a box to finite coordinates, since zero times infinity is not a number. All empty boxes become
/// [`Aabb::EMPTY`].
pub(crate) fn clip_to_space(bounds: &Aabb) -> Aabb {
    if bounds.is_empty() {
        return Aabb::EMPTY;
    }
    let edge = DVec3::splat(MAX_COORDINATE_M);
    Aabb { min: bounds.min.clamp(-edge, edge), max: bounds.max.clamp(-edge, edge) }
}

/// A volume prepared for tests of many boxes.
pub(crate) struct PreparedVolume<'a> {
    sphere: Option<BoundingSphere>,
    cone: Option<PreparedCone>,
    planes: &'a [Plane],
}

/// Position of a node's bounds relative to a volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Containment {
    /// No box in the node intersects the volume.
    Outside,
    /// Every box in the node that is not empty intersects the volume.
    Inside,
    /// Each box must be tested, except against the shapes of the mask.
    Partial(ShapeMask),
}

/// The shapes that contain a node's bounds: they need no test below that node. One bit per shape; shapes from number 64
/// on have no bit and are always tested.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct ShapeMask(u64);

const SPHERE: u32 = 0;
const CONE: u32 = 1;
const FIRST_PLANE: u32 = 2;

impl<'a> PreparedVolume<'a> {
    pub(crate) fn new(volume: &'a CullVolume) -> Self {
        let cone = volume.cone.as_ref().map(PreparedCone::new);
        Self { sphere: volume.sphere, cone, planes: &volume.planes.planes }
    }

    /// Returns whether the box may intersect all shapes, given those that contain a box around it.
    pub(crate) fn intersects(&self, bounds: &Aabb, inside: ShapeMask) -> bool {
        !bounds.is_empty()
            && self.sphere.iter().all(|sphere| inside.has(SPHERE) || sphere.intersects(bounds))
            && self.cone.iter().all(|cone| inside.has(CONE) || cone.intersects(bounds))
            && self.planes().all(|(number, plane)| inside.has(number) || plane.intersects(bounds))
    }

    /// Classifies a node's bounds, given the shapes that contain its parent's bounds.
    pub(crate) fn classify(&self, bounds: &Aabb, inside: ShapeMask) -> Containment {
        if !self.intersects(bounds, inside) {
            return Containment::Outside;
        }
        let mut mask = inside;
        let mut inside_all = true;
        let mut update = |number, contains| if contains { mask.add(number) } else { inside_all = false };
        if let Some(sphere) = &self.sphere {
            update(SPHERE, inside.has(SPHERE) || sphere.contains(bounds));
        }
        if let Some(cone) = &self.cone {
            update(CONE, inside.has(CONE) || cone.contains(bounds));
        }
        for (number, plane) in self.planes() {
            update(number, inside.has(number) || plane.contains(bounds));
        }
        if inside_all { Containment::Inside } else { Containment::Partial(mask) }
    }

    fn planes(&self) -> impl Iterator<Item = (u32, &Plane)> {
        (FIRST_PLANE..).zip(self.planes)
    }
}

impl ShapeMask {
    fn has(self, number: u32) -> bool {
        self.0 & Self::bit(number) != 0
    }

    fn add(&mut self, number: u32) {
        self.0 |= Self::bit(number);
    }

    fn bit(number: u32) -> u64 {
        1u64.checked_shl(number).unwrap_or(0)
    }
}
