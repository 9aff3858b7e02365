//! Where shadow rays start.

use glam::Vec3;

/// How far a ray starts from its surface per metre of the receiver's and the scene's coordinates: 16 times the
/// rounding error of f32.
pub const OFFSET_PER_COORDINATE: f32 = 1.0 / (1 << 20) as f32;

/// How far a ray starts from its surface per metre of view distance.
pub const OFFSET_PER_VIEW_DISTANCE: f32 = 1.0 / (1 << 17) as f32;

/// A point of a surface, as a picture of positions has it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReceiverPoint {
    /// Metres relative to the frame's origin.
    pub position: Vec3,
    /// Of the triangle itself, towards the viewer, unit length.
    pub geometric_normal: Vec3,
    /// How far it is from the viewer, metres.
    pub view_distance_m: f32,
}

impl ReceiverPoint {
    /// How far from the surface its rays start, metres, in a scene of this
    /// [reach](super::RayScene::reach_m). The [module](super) has the derivation.
    #[must_use]
    pub fn offset_m(&self, reach_m: f32) -> f32 {
        let coordinates_m = 2.0 * self.position.abs().max_element() + reach_m;
        OFFSET_PER_COORDINATE * coordinates_m + OFFSET_PER_VIEW_DISTANCE * self.view_distance_m
    }

    /// Where its rays start: above the side that the viewer sees. Light that comes from below that side does
    /// not reach it; so there are no rays to start on the other side.
    #[must_use]
    pub fn ray_origin(&self, reach_m: f32) -> Vec3 {
        self.position + self.geometric_normal * self.offset_m(reach_m)
    }
}
