//! Chooses views of a scene automatically.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use shadowgraph_scene::{Aabb, Camera, Projection, Scene, origin_near};
use shadowgraph_shadows::rays::{NearestHit, Ray};

use shadowgraph::SceneRays;

use crate::Error;

/// Height of a person's eyes, metres.
const EYE_HEIGHT_M: f64 = 1.7;

/// Maximum eye height as a fraction of the scene's height, because scenes can have any scale.
const MAX_EYE_HEIGHT_FRACTION: f64 = 0.15;

/// Number of candidate positions for each view inside the scene.
const CANDIDATES: u32 = 256;

/// Number of directions that are tried at each position.
const DIRECTIONS: u32 = 16;

/// Vertical field of view, radians.
const FOV_Y: f64 = 0.9;

/// Aspect ratio for which views from outside frame the scene.
const ASPECT: f64 = 16.0 / 9.0;

/// Chooses views: alternately from outside, framing the scene, and at eye height above a floor, in the most open
/// direction. The result is deterministic. If no such floor is found, all views are from outside.
///
/// # Errors
/// If the scene's triangles cannot be traced.
pub fn automatic_views(scene: &Scene, count: usize) -> Result<Vec<(String, Camera)>, Error> {
    let bounds = scene.bounds();
    let origin_world = origin_near(bounds.center());
    let finder = Finder { rays: SceneRays::new(scene, origin_world)?, origin_world, bounds };
    let mut views = Vec::with_capacity(count);
    for index in 0..count as u32 {
        let inside = (index % 2 == 1).then(|| finder.inside(index * CANDIDATES)).flatten();
        views.push(match inside {
            Some(camera) => (format!("inside {}", index + 1), camera),
            None => (format!("outside {}", index + 1), outside(&bounds, index)),
        });
    }
    Ok(views)
}

/// Returns the camera that frames the scene, rotated around the scene's centre.
fn outside(bounds: &Aabb, index: u32) -> Camera {
    let framing = Camera::framing(bounds, ASPECT);
    if bounds.is_empty() {
        return framing;
    }
    let (center, eye) = (bounds.center(), framing.position_world());
    let turn = glam::DQuat::from_rotation_y(f64::from(index) * PI * (3.0 - 5f64.sqrt()));
    let eye = center + turn * (eye - center);
    Camera { name: None, ..Camera::look_at(eye, center, DVec3::Y, framing.projection) }
}

struct Finder {
    rays: SceneRays,
    origin_world: DVec3,
    bounds: Aabb,
}

impl Finder {
    /// Returns the best camera above a floor among [`CANDIDATES`] positions of a sequence that begins at `seed`.
    fn inside(&self, seed: u32) -> Option<Camera> {
        let size = self.bounds.max - self.bounds.min;
        let height_m = EYE_HEIGHT_M.min(size.y * MAX_EYE_HEIGHT_FRACTION);
        let tried = (seed + 1..=seed + CANDIDATES).filter_map(|index| {
            let candidate = self.bounds.min + size * halton(index);
            let down = self.cast(candidate, DVec3::NEG_Y)?;
            let floor = candidate - DVec3::Y * down.distance_m;
            let eye = floor + DVec3::Y * height_m;
            let above = self.cast(floor + DVec3::Y * height_m * 0.01, DVec3::Y);
            let (direction, clearance_m) = self.most_open_direction(eye, height_m)?;
            // Not inside objects or below their floor, and not in front of a wall.
            let is_free = !down.from_behind && above.is_none_or(|above| above.distance_m > 1.5 * height_m);
            (is_free && clearance_m > 4.0 * height_m).then_some((eye, direction, clearance_m))
        });
        let (eye, direction, _) = tried.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let projection = Projection::Perspective { fov_y: FOV_Y, near: (height_m * 0.1).min(0.1), far: None };
        Some(Camera::look_at(eye, eye + direction - DVec3::Y * 0.15, DVec3::Y, projection))
    }

    /// Returns the horizontal direction with the largest distance to a front face, and the distance; `None` if any side is
    /// too close, or if many faces are seen from behind, which means that the eye is inside an object.
    fn most_open_direction(&self, eye: DVec3, height_m: f64) -> Option<(DVec3, f64)> {
        let directions = (0..DIRECTIONS).map(|direction| {
            let (sin, cos) = (TAU * f64::from(direction) / f64::from(DIRECTIONS)).sin_cos();
            DVec3::new(cos, 0.0, sin)
        });
        let hits: Vec<_> =
            directions.filter_map(|direction| Some((direction, self.cast(eye, direction)?))).collect();
        let behind = hits.iter().filter(|(_, hit)| hit.from_behind).count();
        let tight = hits.iter().any(|(_, hit)| hit.distance_m < 0.3 * height_m);
        if tight || behind * 4 > hits.len() {
            return None;
        }
        let fronts = hits.into_iter().filter(|(_, hit)| !hit.from_behind);
        fronts.map(|(direction, hit)| (direction, hit.distance_m)).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Returns the nearest surface along a ray; `None` if there is none.
    fn cast(&self, from: DVec3, direction: DVec3) -> Option<Hit> {
        let origin: Vec3 = (from - self.origin_world).as_vec3();
        let ray = Ray::new(origin, direction.as_vec3(), 0.0, f32::INFINITY);
        let NearestHit { distance_m, corners: [a, b, c], .. } = self.rays.rays().nearest_hit(&ray)?;
        let from_behind = (b - a).cross(c - a).dot(direction.as_vec3()) > 0.0;
        Some(Hit { distance_m: f64::from(distance_m), from_behind })
    }
}

/// Nearest surface along a ray.
struct Hit {
    /// Distance, metres.
    distance_m: f64,
    from_behind: bool,
}

/// A sequence of points that fills the unit cube evenly (Halton 1960), bases 2, 3 and 5.
fn halton(index: u32) -> DVec3 {
    let along = |base: u32| {
        let (mut index, mut part, mut at) = (index, 1.0, 0.0);
        while index > 0 {
            part /= f64::from(base);
            at += part * f64::from(index % base);
            index /= base;
        }
        at
    };
    DVec3::new(along(2), along(3), along(5))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use shadowgraph_samples::test_scenes::test_scene;

    #[test]
    fn every_second_view_is_above_a_floor_and_all_are_different() {
        let scene = test_scene("interior").unwrap();
        let views = automatic_views(&scene, 6).unwrap();
        let inside: Vec<_> = views.iter().filter(|(name, _)| name.starts_with("inside")).collect();
        assert_eq!((views.len(), inside.len()), (6, 3));
        for (name, camera) in &inside {
            let height = camera.position_world().y;
            assert!((0.1..2.5).contains(&height), "{name} is {height} m high");
        }
        let eyes: std::collections::BTreeSet<_> =
            views.iter().map(|(_, camera)| camera.position_world().to_array().map(f64::to_bits)).collect();
        assert_eq!(eyes.len(), 6);
        assert_eq!(automatic_views(&scene, 6).unwrap(), views);
    }

    #[test]
    fn an_empty_scene_has_views_too() {
        assert_eq!(automatic_views(&Scene::default(), 2).unwrap().len(), 2);
    }
}
