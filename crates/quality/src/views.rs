//! Choosing views of a scene that names none.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec3};
use shadowgraph_scene::{Aabb, Camera, Projection, Scene, origin_near};
use shadowgraph_shadows::rays::{Ray, RayScene};

use shadowgraph::ray_scene;

use crate::Error;

/// The height of a person's eyes, metres.
const EYE_M: f64 = 1.7;

/// The most that eyes are above the floor, in parts of the scene's height: scenes can be of any scale.
const EYE_PART: f64 = 0.15;

/// So many places are tried for each view among things.
const TRIES: u32 = 256;

/// So many ways are looked from a place.
const WAYS: u32 = 16;

/// The vertical angle of lenses, radians.
const FOV_Y: f64 = 0.9;

/// The picture's width over its height that views from outside are made for.
const ASPECT: f64 = 16.0 / 9.0;

/// Chooses views: in turn one from outside that frames the scene, and one at eye height over a floor that looks where
/// there is room. Always the same ones for a scene. Where no such floor is found, all are from outside.
///
/// # Errors
/// If the scene's triangles cannot be traced.
pub fn automatic_views(scene: &Scene, count: usize) -> Result<Vec<(String, Camera)>, Error> {
    let bounds = scene.bounds();
    let origin_world = origin_near(bounds.center());
    let finder = Finder { rays: ray_scene(scene, origin_world)?, origin_world, bounds };
    let mut views = Vec::with_capacity(count);
    for index in 0..count as u32 {
        let inside = (index % 2 == 1).then(|| finder.inside(index * TRIES)).flatten();
        views.push(match inside {
            Some(camera) => (format!("inside {}", index + 1), camera),
            None => (format!("outside {}", index + 1), outside(&bounds, index)),
        });
    }
    Ok(views)
}

/// Turns the camera that frames the scene around the scene's middle.
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
    rays: RayScene,
    origin_world: DVec3,
    bounds: Aabb,
}

impl Finder {
    /// A camera over a floor, the best of [`TRIES`] places of a sequence that begins at `seed`.
    fn inside(&self, seed: u32) -> Option<Camera> {
        let size = self.bounds.max - self.bounds.min;
        let height_m = EYE_M.min(size.y * EYE_PART);
        let tried = (seed + 1..=seed + TRIES).filter_map(|index| {
            let place = self.bounds.min + size * halton(index);
            let down = self.look(place, DVec3::NEG_Y)?;
            let floor = place - DVec3::Y * down.free_m;
            let eye = floor + DVec3::Y * height_m;
            let above = self.look(floor + DVec3::Y * height_m * 0.01, DVec3::Y);
            let (way, room_m) = self.widest(eye, height_m)?;
            // Not inside of things or under their floor, and not in front of a wall.
            let stands = !down.from_behind && above.is_none_or(|above| above.free_m > 1.5 * height_m);
            (stands && room_m > 4.0 * height_m).then_some((eye, way, room_m))
        });
        let (eye, way, _) = tried.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let projection = Projection::Perspective { fov_y: FOV_Y, near: (height_m * 0.1).min(0.1), far: None };
        Some(Camera::look_at(eye, eye + way - DVec3::Y * 0.15, DVec3::Y, projection))
    }

    /// The level way with the most room to something that is seen from its front, and how much room there is; `None` if
    /// it is tight on any side, or if many things are seen from behind: then the eye is inside of them.
    fn widest(&self, eye: DVec3, height_m: f64) -> Option<(DVec3, f64)> {
        let ways = (0..WAYS).map(|way| {
            let (sin, cos) = (TAU * f64::from(way) / f64::from(WAYS)).sin_cos();
            DVec3::new(cos, 0.0, sin)
        });
        let samples: Vec<_> = ways.filter_map(|way| Some((way, self.look(eye, way)?))).collect();
        let behind = samples.iter().filter(|(_, samples)| samples.from_behind).count();
        let tight = samples.iter().any(|(_, samples)| samples.free_m < 0.3 * height_m);
        if tight || behind * 4 > samples.len() {
            return None;
        }
        let fronts = samples.into_iter().filter(|(_, samples)| !samples.from_behind);
        fronts.map(|(way, samples)| (way, samples.free_m)).max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The next surface; `None`: there is none.
    fn look(&self, from: DVec3, way: DVec3) -> Option<Look> {
        let origin: Vec3 = (from - self.origin_world).as_vec3();
        let ray = Ray::new(origin, way.as_vec3(), 0.0, f32::INFINITY);
        let (free_m, triangle) = self.rays.nearest_triangle(&ray)?;
        let [a, b, c] = self.rays.triangles().get(triangle)?.corners();
        let from_behind = (b - a).cross(c - a).dot(way.as_vec3()) > 0.0;
        Some(Look { free_m: f64::from(free_m), from_behind })
    }
}

/// What is seen along a way.
struct Look {
    /// How far away it is, metres.
    free_m: f64,
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
    fn every_second_view_stands_on_a_floor_and_all_are_different() {
        let scene = test_scene("interior").unwrap();
        let views = automatic_views(&scene, 6).unwrap();
        let inside: Vec<_> = views.iter().filter(|(name, _)| name.starts_with("inside")).collect();
        assert_eq!((views.len(), inside.len()), (6, 3));
        for (name, camera) in &inside {
            let height = camera.position_world().y;
            assert!((0.1..2.5).contains(&height), "{name} is {height} m high");
        }
        let places: std::collections::BTreeSet<_> =
            views.iter().map(|(_, camera)| camera.position_world().to_array().map(f64::to_bits)).collect();
        assert_eq!(places.len(), 6);
        assert_eq!(automatic_views(&scene, 6).unwrap(), views);
    }

    #[test]
    fn a_scene_of_nothing_has_views_too() {
        assert_eq!(automatic_views(&Scene::default(), 2).unwrap().len(), 2);
    }
}
