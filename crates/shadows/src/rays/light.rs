//! The visibility of a light from a receiver.

use glam::{Vec2, Vec3};

use super::{Ray, RayScene, ReceiverPoint};

/// The fraction of the distance to a point light that its rays travel: they end just before geometry around the light.
pub const LIGHT_DISTANCE_FRACTION: f32 = 1.0 - 1.0 / (1 << 12) as f32;

/// The angle from one sample on the light's disc to the next, radians.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// The position and the size of a light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// A light at infinity, in the same direction from everywhere.
    Directional {
        /// The direction towards the light, unit length.
        to_light: Vec3,
        /// Half of its angular diameter, radians, from 0 to below a right angle. The sun's is
        /// 0.004 65.
        angular_radius: f32,
    },
    /// A point or spot light. A spot light's cone is not taken into account.
    Point {
        /// The centre, metres relative to the frame's origin.
        position: Vec3,
        /// Radius of the emitting disc, which always faces the receiver, metres, 0 or above.
        radius_m: f32,
    },
}

/// The exact visibility of a light's centre from a receiver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundTruth {
    /// Visibility of the light, linear red, green and blue: 1 lit, 0 in shadow, in between behind translucent surfaces.
    pub visibility: Vec3,
    /// Whether the surface faces away from the light or is edge-on to it: dark without any blocker.
    pub faces_away: bool,
    /// Distance to the nearest opaque blocker, metres; `None` if there is none, if it was not requested, or if
    /// the surface faces away.
    pub blocker_m: Option<f32>,
}

/// Returns the visibility of the light's centre from the receiver, and the distance of the nearest blocker if
/// `with_blocker`, which takes longer.
#[must_use]
pub fn trace_hard(
    scene: &RayScene,
    light: &LightShape,
    receiver: &ReceiverPoint,
    with_blocker: bool,
) -> GroundTruth {
    let Some(ray) = light.ray(scene, receiver, Vec2::ZERO) else {
        return GroundTruth { visibility: Vec3::ZERO, faces_away: true, blocker_m: None };
    };
    let blocker_m = if with_blocker { scene.nearest_distance(&ray) } else { None };
    let visibility = if blocker_m.is_some() { Vec3::ZERO } else { scene.transmittance(&ray) };
    GroundTruth { visibility, faces_away: false, blocker_m }
}

/// Returns the visibility of the light's disc from the receiver, linear red, green and blue, 0 to 1, by `rays` rays (at least
/// one) to points of a Vogel spiral over the disc: always the same points, each for the same area. 0 where the surface faces
/// away from the light's centre; points of the light below the surface's horizon count as occluded.
#[must_use]
pub fn trace_soft(scene: &RayScene, light: &LightShape, receiver: &ReceiverPoint, rays: u32) -> Vec3 {
    if light.ray(scene, receiver, Vec2::ZERO).is_none() {
        return Vec3::ZERO;
    }
    let rays = rays.max(1);
    let ray = |index| light.ray(scene, receiver, on_disc(index, rays));
    (0..rays).filter_map(ray).map(|ray| scene.transmittance(&ray)).sum::<Vec3>() / rays as f32
}

/// Returns point `index` of `count` on a disc of radius 1.
fn on_disc(index: u32, count: u32) -> Vec2 {
    let radius = ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
    let (sin, cos) = (f64::from(index) * GOLDEN_ANGLE).sin_cos();
    Vec2::new((radius * cos) as f32, (radius * sin) as f32)
}

impl LightShape {
    /// Returns the ray to a point of the light's disc (the disc's radius is 1); `None` if the surface faces away from
    /// that point, or if the receiver is at the light.
    #[must_use]
    pub fn ray(&self, scene: &RayScene, receiver: &ReceiverPoint, on_disc: Vec2) -> Option<Ray> {
        let origin = receiver.ray_origin(scene.max_coordinate_m());
        let (to_point, max_m) = match *self {
            Self::Directional { to_light, angular_radius } => {
                (to_light + across(to_light, on_disc) * angular_radius.tan(), f32::INFINITY)
            }
            Self::Point { position, radius_m } => {
                let to_center = (position - origin).try_normalize()?;
                let to_point = position + across(to_center, on_disc) * radius_m - origin;
                (to_point, to_point.length() * LIGHT_DISTANCE_FRACTION)
            }
        };
        let direction = to_point.try_normalize()?;
        (receiver.geometric_normal.dot(direction) > 0.0).then(|| Ray::new(origin, direction, 0.0, max_m))
    }
}

/// Returns the vector of these coordinates in the plane perpendicular to `direction`.
fn across(direction: Vec3, point: Vec2) -> Vec3 {
    let (right, up) = direction.any_orthonormal_pair();
    right * point.x + up * point.y
}
