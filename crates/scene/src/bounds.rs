//! Boxes, planes and convex volumes in f64 world space.

use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};

/// An axis-aligned box. It is empty when `min` is above `max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aabb {
    /// The lowest corner, metres.
    pub min: DVec3,
    /// The highest corner, metres.
    pub max: DVec3,
}

impl Aabb {
    /// The empty box: the neutral element of [`union`](Self::union).
    pub const EMPTY: Self = Self { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };

    /// Returns the smallest box around the points; [`EMPTY`](Self::EMPTY) for no points.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shadowgraph_scene::Aabb;
    /// let bounds = Aabb::from_points([DVec3::ZERO, DVec3::new(1.0, -2.0, 3.0)]);
    /// assert_eq!(bounds.min, DVec3::new(0.0, -2.0, 0.0));
    /// ```
    #[must_use]
    pub fn from_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, point| Self {
            min: bounds.min.min(point),
            max: bounds.max.max(point),
        })
    }

    /// Returns the smallest box around both boxes.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Returns whether the box contains no point. A flat box or a single point is not empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Returns the centre of the box, or the origin for an empty box.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { self.min + self.half_extent() }
    }

    /// Returns half the size along each axis, metres; zero for an empty box.
    #[must_use]
    pub fn half_extent(&self) -> DVec3 {
        if self.is_empty() { DVec3::ZERO } else { (self.max - self.min) * 0.5 }
    }

    /// Returns the radius of the bounding sphere around [`center`](Self::center), metres.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.half_extent().length()
    }

    /// Returns whether the point lies in the box or on its surface.
    #[must_use]
    pub fn contains_point(&self, point: DVec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Returns the eight corners: bit 0 of the index selects x, bit 1 y, bit 2 z (set: `max`).
    #[must_use]
    pub fn corners(&self) -> [DVec3; 8] {
        let (a, b) = (self.min, self.max);
        std::array::from_fn(|i| {
            let pick = |bit: usize, low: f64, high: f64| if i & bit == 0 { low } else { high };
            DVec3::new(pick(1, a.x, b.x), pick(2, a.y, b.y), pick(4, a.z, b.z))
        })
    }

    /// Returns the smallest axis-aligned box around the transformed corners of this box.
    #[must_use]
    pub fn transformed(&self, transform: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        Self::from_points(self.corners().map(|corner| transform.transform_point3(corner)))
    }
}

/// A half space: the points with `normal · point + distance >= 0` are inside.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    /// The normal, towards the inside, unit length.
    pub normal: DVec3,
    /// The signed distance of the world's origin from the plane, metres, positive inside.
    pub distance: f64,
}

impl Plane {
    /// Creates the plane through `point` whose inside lies in the direction of `normal` (unit length).
    #[must_use]
    pub fn through(point: DVec3, normal: DVec3) -> Self {
        Self { normal, distance: -normal.dot(point) }
    }

    /// Returns the signed distance of `point` from the plane, metres, positive inside.
    #[must_use]
    pub fn signed_distance(&self, point: DVec3) -> f64 {
        self.normal.dot(point) + self.distance
    }
}

/// The intersection of half spaces; without planes, all of space.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ConvexVolume {
    /// The half spaces.
    pub planes: Vec<Plane>,
}

impl ConvexVolume {
    /// Returns whether the box may intersect the volume. Conservative: boxes near an edge of the volume may be
    /// kept although they lie outside, but a box with a point inside is never rejected. An empty box never intersects.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shadowgraph_scene::{Aabb, ConvexVolume, Plane};
    /// let volume = ConvexVolume { planes: vec![Plane::through(DVec3::ZERO, DVec3::X)] };
    /// let unit = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    /// assert!(volume.intersects(&unit));
    /// assert!(!volume.intersects(&Aabb { min: unit.min - DVec3::X * 3.0, max: unit.max - DVec3::X * 3.0 }));
    /// ```
    #[must_use]
    pub fn intersects(&self, bounds: &Aabb) -> bool {
        !bounds.is_empty()
            && self.planes.iter().all(|plane| {
                // The farthest corner along the normal: if it is outside, the whole box is.
                let corner = DVec3::select(plane.normal.cmpge(DVec3::ZERO), bounds.max, bounds.min);
                plane.signed_distance(corner) >= 0.0
            })
    }

    /// Returns whether the point lies in the volume or on its surface.
    #[must_use]
    pub fn contains_point(&self, point: DVec3) -> bool {
        self.planes.iter().all(|plane| plane.signed_distance(point) >= 0.0)
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn the_empty_box_is_the_neutral_element_of_union() {
        let unit = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
        assert!(Aabb::EMPTY.is_empty() && !unit.is_empty());
        assert_eq!(Aabb::EMPTY.union(&unit), unit);
        assert_eq!(Aabb::EMPTY.transformed(&DAffine3::from_scale(DVec3::NEG_ONE)), Aabb::EMPTY);
        assert_eq!((Aabb::EMPTY.center(), Aabb::EMPTY.radius()), (DVec3::ZERO, 0.0));
        assert!(!ConvexVolume::default().intersects(&Aabb::EMPTY));
    }

    #[test]
    fn flat_boxes_and_points_are_not_empty() {
        let flat = Aabb { min: DVec3::new(-1.0, 0.0, -1.0), max: DVec3::new(1.0, 0.0, 1.0) };
        assert!(!flat.is_empty() && flat.contains_point(DVec3::ZERO));
        assert!(!Aabb::from_points([DVec3::ONE]).is_empty());
        assert!(Aabb { min: DVec3::NAN, max: DVec3::ONE }.is_empty());
    }

    #[test]
    fn corners_are_numbered_by_axis() {
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 2.0, 3.0) };
        let corners = bounds.corners();
        assert_eq!((corners[0], corners[1], corners[6]), (DVec3::ZERO, DVec3::X, DVec3::new(0.0, 2.0, 3.0)));
    }

    proptest! {
        #[test]
        fn a_transformed_box_contains_the_transformed_contents(
            min in prop::array::uniform3(-100.0..100.0), size in prop::array::uniform3(0.0..50.0),
            matrix in prop::array::uniform9(-3.0..3.0), offset in prop::array::uniform3(-1e4..1e4),
            at in prop::array::uniform3(0.0..=1.0),
        ) {
            let bounds = Aabb { min: min.into(), max: DVec3::from(min) + DVec3::from(size) };
            let matrix = DMat3::from_cols_array(&matrix);
            let transform = DAffine3::from_mat3_translation(matrix, offset.into());
            let transformed = bounds.transformed(&transform);
            for corner in bounds.corners() {
                prop_assert!(transformed.contains_point(transform.transform_point3(corner)));
            }
            let inner = transform.transform_point3(bounds.min + (bounds.max - bounds.min) * DVec3::from(at));
            let grown = Aabb { min: transformed.min - 1e-9, max: transformed.max + 1e-9 };
            prop_assert!(grown.contains_point(inner));
        }
    }
}
