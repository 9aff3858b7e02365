//! The part of the view in which shadows are visible.

use glam::{DMat3, DVec3};
use shadowgraph_scene::{Aabb, Camera, Plane};

use super::supporting_planes::SupportingPlanes;

/// The convex hull of all visible receivers: a slice of a view frustum, or a box. It has eight corners; it may be flat, or
/// have edges of zero length.
#[derive(Clone, Debug, PartialEq)]
pub struct ReceiverHull {
    corners: [DVec3; 8],
    faces: Vec<Plane>,
}

/// The corners at the ends of each edge. The far ones come first: they are the longest of their direction.
const EDGES: [[usize; 2]; 12] =
    [[4, 5], [6, 7], [4, 6], [5, 7], [0, 4], [1, 5], [2, 6], [3, 7], [0, 1], [2, 3], [0, 2], [1, 3]];

/// The corners around each face.
const FACES: [[usize; 4]; 6] =
    [[0, 2, 6, 4], [1, 3, 7, 5], [0, 1, 5, 4], [2, 3, 7, 6], [4, 5, 7, 6], [0, 1, 3, 2]];

/// The sine of the angle between a face's diagonals below which it counts as a line.
const LINE: f64 = 1e-12;

impl ReceiverHull {
    /// Creates the hull of eight corners in absolute world space, metres: bit 0 of the index chooses x, bit 1 y, bit
    /// 2 the distance, as in [`Camera::slice_corners_view`] and [`Aabb::corners`].
    ///
    /// With corners that are not finite the hull has no faces, and nothing is culled.
    #[must_use]
    pub fn new(corners: [DVec3; 8]) -> Self {
        let mut faces = SupportingPlanes::new(&corners, 0.0);
        for face in FACES {
            let [a, b, c, d] = face.map(|corner| corners[corner]);
            // Diagonals are long even where a side is zero.
            let (down, up) = (c - a, d - b);
            let across = down.cross(up);
            if across.length() > LINE * down.length() * up.length() {
                faces.push_if_outside(across.normalize(), a);
            }
        }
        let faces = faces.into_planes();
        Self { corners, faces }
    }

    /// Creates the hull of a camera's frustum from `near_m` to `far_m` (view depth, metres): from the near plane to
    /// the shadow distance, it holds all visible receivers. `aspect` is the image's width over its height.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shadowgraph_scene::{Camera, Projection};
    /// use shadowgraph_shadows::ReceiverHull;
    /// let projection = Projection::Perspective { fov_y: 0.8, near: 0.1, far: None };
    /// let camera = Camera::look_at(DVec3::Y, DVec3::NEG_Z, DVec3::Y, projection);
    /// let view = ReceiverHull::from_view(&camera, 1.5, camera.near(), 100.0);
    /// let may_matter = view.swept_towards(DVec3::Y, 0.5);
    /// assert!(may_matter.contains_point(DVec3::new(0.0, 1000.0, -50.0)));
    /// assert!(!may_matter.contains_point(DVec3::new(0.0, 1000.0, 50.0)));
    /// ```
    #[must_use]
    pub fn from_view(camera: &Camera, aspect: f64, near_m: f64, far_m: f64) -> Self {
        let corners = camera.slice_corners_view(aspect, near_m, far_m);
        Self::new(corners.map(|corner| camera.world_from_view.transform_point3(corner)))
    }

    /// Creates the hull of a box, such as the bounds of all receivers.
    #[must_use]
    pub fn from_box(bounds: &Aabb) -> Self {
        Self::new(bounds.corners())
    }

    /// Returns the corners, in the order of [`new`](Self::new).
    #[must_use]
    pub fn corners(&self) -> &[DVec3; 8] {
        &self.corners
    }

    /// Returns the two ends of each of the twelve edges.
    pub fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        EDGES.into_iter().map(|edge| edge.map(|corner| self.corners[corner]))
    }

    /// Returns the planes of the faces that have an area; for a flat hull, both orientations of its plane.
    #[must_use]
    pub fn faces(&self) -> &[Plane] {
        &self.faces
    }

    /// Returns the bounding box of the hull.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        Aabb::from_points(self.corners)
    }

    /// Returns whether all corners are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.corners.iter().all(|corner| corner.is_finite())
    }

    /// Returns the hull on a light's axes: x and y across the light, z towards it. `light_from_world` is a rotation.
    #[must_use]
    pub fn in_light_space(&self, light_from_world: DMat3) -> Self {
        Self::new(self.corners.map(|corner| light_from_world * corner))
    }
}

#[cfg(test)]
mod tests;
