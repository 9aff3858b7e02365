//! A camera that turns around a point.

use std::f64::consts::FRAC_PI_2;

use glam::{DQuat, DVec3};
use shadowgraph::scene::{Aabb, Camera, Projection};

/// The steepest pitch, radians.
const STEEPEST: f64 = FRAC_PI_2 - 0.01;

/// A camera that turns around a point, moves with it and comes closer. Before the first move it is the camera that it was created from.
#[derive(Clone, Debug)]
pub struct Orbit {
    camera: Camera,
    target: DVec3,
    distance_m: f64,
    yaw: f64,
    pitch: f64,
    radius_m: f64,
}

impl Orbit {
    /// Starts at a camera. The point is in front of it, as far away as the middle of `bounds` or a part of it.
    #[must_use]
    pub fn new(camera: Camera, bounds: &Aabb) -> Self {
        let (eye, ahead) = (camera.position_world(), camera.forward_world());
        let radius_m = if bounds.is_empty() { 1.0 } else { bounds.radius().max(1e-3) };
        let to_middle = if bounds.is_empty() { 1.0 } else { (bounds.center() - eye).dot(ahead) };
        let distance_m = to_middle.max(radius_m * 0.05).max(camera.near() * 2.0);
        Self {
            target: eye + ahead * distance_m,
            distance_m,
            yaw: (-ahead.x).atan2(-ahead.z),
            pitch: ahead.y.clamp(-1.0, 1.0).asin().clamp(-STEEPEST, STEEPEST),
            radius_m,
            camera,
        }
    }

    /// Returns the camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Turns around the point: to the left and upwards, radians.
    pub fn turn(&mut self, left: f64, up: f64) {
        self.yaw = (self.yaw + left) % std::f64::consts::TAU;
        self.pitch = (self.pitch + up).clamp(-STEEPEST, STEEPEST);
        self.place();
    }

    /// Moves with the point: to the right, upwards and ahead, as fractions of the distance between them.
    pub fn shift(&mut self, right: f64, up: f64, ahead: f64) {
        let turned = DQuat::from_rotation_y(self.yaw) * DQuat::from_rotation_x(self.pitch);
        self.target += turned * DVec3::new(right, up, -ahead) * self.distance_m;
        self.place();
    }

    /// Multiplies the distance from the point, between a thousandth and a hundred times the radius of the scene.
    pub fn zoom(&mut self, factor: f64) {
        let range = self.radius_m * 1e-3..=self.radius_m * 100.0;
        self.distance_m = (self.distance_m * factor).clamp(*range.start(), *range.end());
        self.place();
    }

    fn place(&mut self) {
        let turned = DQuat::from_rotation_y(self.yaw) * DQuat::from_rotation_x(self.pitch);
        let eye = self.target - turned * DVec3::NEG_Z * self.distance_m;
        let mut projection = self.camera.projection;
        if let Projection::Perspective { near, far, .. } = &mut projection {
            *near = near.min(self.distance_m * 0.1);
            // What is around the point stays visible.
            *far = far.map(|far| far.max(self.distance_m + self.radius_m * 2.0));
        }
        let name = self.camera.name.take();
        self.camera = Camera { name, ..Camera::look_at(eye, self.target, DVec3::Y, projection) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit() -> Orbit {
        let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: Some(20.0) };
        let camera = Camera::look_at(DVec3::new(0.0, 3.0, 10.0), DVec3::Y, DVec3::Y, projection);
        Orbit::new(camera, &Aabb::from_points([DVec3::splat(-2.0), DVec3::splat(2.0)]))
    }

    #[test]
    fn turning_keeps_the_point_and_the_distance() {
        let mut orbit = orbit();
        let (target, distance_m) = (orbit.target, orbit.distance_m);
        let before = orbit.camera().position_world();
        orbit.turn(0.0, 0.0);
        assert!(orbit.camera().position_world().distance(before) < 1e-9, "the first move does not jump");
        orbit.turn(1.0, -9.0);
        let camera = orbit.camera();
        assert!((camera.position_world().distance(target) - distance_m).abs() < 1e-9);
        let to_target = (target - camera.position_world()).normalize();
        assert!(camera.forward_world().distance(to_target) < 1e-6);
        assert!(camera.forward_world().y > -1.0, "never straight down, where up is undefined");
    }

    #[test]
    fn zooming_ends_at_a_range_and_keeps_the_scene_within_the_planes() {
        let mut orbit = orbit();
        orbit.zoom(1e9);
        assert!(orbit.camera().far().is_some_and(|far| far > orbit.distance_m));
        orbit.zoom(1e-9);
        assert!(orbit.camera().near() < orbit.distance_m && orbit.distance_m > 0.0);
    }

    #[test]
    fn shifting_moves_the_point() {
        let mut orbit = orbit();
        let (before, distance_m) = (orbit.target, orbit.distance_m);
        orbit.shift(0.5, 0.0, 0.0);
        assert!((orbit.target - before - DVec3::X * 0.5 * distance_m).length() < 1e-9);
    }
}
