//! How much of a light a receiver sees.

use glam::{Vec2, Vec3};

use super::{Ray, RayScene, ReceiverPoint};

/// The part of the way to a point light that its rays go: they end just before what may hang around it.
pub const LIGHT_DISTANCE_FRACTION: f32 = 1.0 - 1.0 / (1 << 12) as f32;

/// The angle from one sample on the light's disc to the next, radians.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;

/// Where a light is and how large it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// So far away that it is in the same direction from everywhere.
    Directional {
        /// Towards the light, unit length.
        to_light: Vec3,
        /// Half of the angle that it takes up in the sky, radians, from 0 to below a right angle. The sun's is
        /// 0.004 65.
        angular_radius: f32,
    },
    /// A point or spot light. What lies outside of a spot light's cone is not asked here.
    Point {
        /// Its centre, metres relative to the frame's origin.
        position: Vec3,
        /// The radius of the disc, always turned to the receiver, that it shines from, metres, 0 or above.
        radius_m: f32,
    },
}

/// What a receiver truly sees of a light's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundTruth {
    /// What of its light it sees, linear red, green and blue: 1 all, 0 none, between behind what is translucent.
    pub visibility: Vec3,
    /// The surface itself faces away from the light or stands edge-on to it: dark without any blocker.
    pub faces_away: bool,
    /// The distance to the nearest thing between that no light passes, metres; `None` if there is none, if it was not asked for, or if
    /// the surface faces away.
    pub blocker_m: Option<f32>,
}

/// Finds what the receiver sees of the light's centre, and if `with_blocker` how near the nearest blocker is,
/// which takes longer.
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
    let blocker_m = if with_blocker { scene.nearest(&ray) } else { None };
    let visibility = if blocker_m.is_some() { Vec3::ZERO } else { scene.passed(&ray) };
    GroundTruth { visibility, faces_away: false, blocker_m }
}

/// Returns how much of the light the receiver sees, linear red, green and blue, 0 to 1, by `rays` rays (at least one) to the
/// points of a Vogel spiral over the light's disc: always the same ones, each for the same area. 0 where the surface faces
/// away from the light's centre; points of the light below the surface's horizon count as not seen.
#[must_use]
pub fn trace_soft(scene: &RayScene, light: &LightShape, receiver: &ReceiverPoint, rays: u32) -> Vec3 {
    if light.ray(scene, receiver, Vec2::ZERO).is_none() {
        return Vec3::ZERO;
    }
    let rays = rays.max(1);
    let ray = |index| light.ray(scene, receiver, on_disc(index, rays));
    (0..rays).filter_map(ray).map(|ray| scene.passed(&ray)).sum::<Vec3>() / rays as f32
}

/// Point `index` of `count` on a disc of radius 1.
fn on_disc(index: u32, count: u32) -> Vec2 {
    let radius = ((f64::from(index) + 0.5) / f64::from(count)).sqrt();
    let (sin, cos) = (f64::from(index) * GOLDEN_ANGLE).sin_cos();
    Vec2::new((radius * cos) as f32, (radius * sin) as f32)
}

impl LightShape {
    /// The ray to a point of the light's disc (the disc's radius is 1); `None` if the surface faces away from
    /// that point, or if the receiver is at the light.
    #[must_use]
    pub fn ray(&self, scene: &RayScene, receiver: &ReceiverPoint, on_disc: Vec2) -> Option<Ray> {
        let origin = receiver.ray_origin(scene.reach_m());
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

/// The vector of these coordinates in the plane across `direction`.
fn across(direction: Vec3, at: Vec2) -> Vec3 {
    let (right, up) = direction.any_orthonormal_pair();
    right * at.x + up * at.y
}
