//! The origins of shadow rays.

use glam::Vec3;

/// Offset of a ray's origin from its surface per metre of the receiver's and the scene's coordinates: 16 times the
/// rounding error of f32.
pub const OFFSET_PER_COORDINATE: f32 = 1.0 / (1 << 20) as f32;

/// Offset of a ray's origin from its surface per metre of view distance.
pub const OFFSET_PER_VIEW_DISTANCE: f32 = 1.0 / (1 << 17) as f32;

/// A point of a surface, with the precision of a position buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverPoint {
    /// Position, metres relative to the frame's origin.
    pub position: Vec3,
    /// Normal of the triangle, towards the viewer, unit length.
    pub geometric_normal: Vec3,
    /// Distance from the viewer, metres.
    pub view_distance_m: f32,
}

impl ReceiverPoint {
    /// Returns the offset of its rays' origins from the surface, metres, in a scene with this
    /// [largest coordinate](super::RayScene::max_coordinate_m). The [module](super) has the derivation.
    #[must_use]
    pub fn offset_m(&self, max_coordinate_m: f32) -> f32 {
        let coordinates_m = 2.0 * self.position.abs().max_element() + 1.5 * max_coordinate_m;
        OFFSET_PER_COORDINATE * coordinates_m + OFFSET_PER_VIEW_DISTANCE * self.view_distance_m
    }

    /// Returns the origin of its rays: above the side that faces the viewer. Light from below that side does
    /// not reach it, so no rays start on the other side.
    #[must_use]
    pub fn ray_origin(&self, max_coordinate_m: f32) -> Vec3 {
        self.position + self.geometric_normal * self.offset_m(max_coordinate_m)
    }
}
