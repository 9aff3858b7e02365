//! A camera that flies.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DQuat, DVec3};

use shadowgraph::scene::Camera;

/// Radians that the view turns for each point that the pointer is dragged.
const RADIANS_PER_POINT: f64 = 0.005;
/// How near to straight up or down the view turns.
const STEEPEST: f64 = FRAC_PI_2 - 0.01;

/// Where a camera is and how fast it flies.
#[derive(Clone, Debug)]
pub(super) struct Fly {
    camera: Camera,
    yaw: f64,
    pitch: f64,
    /// Metres a second.
    pub(super) speed: f64,
}

/// Which ways the camera is to fly, each -1 to 1: right, up, ahead.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Steer {
    pub(super) right: f64,
    pub(super) up: f64,
    pub(super) ahead: f64,
    pub(super) fast: bool,
}

impl Fly {
    /// Starts where a camera is; `reach_m` is how large the scene is about.
    pub(super) fn new(camera: Camera, reach_m: f64) -> Self {
        let ahead = camera.forward_world();
        let (yaw, pitch) = ((-ahead.x).atan2(-ahead.z), ahead.y.clamp(-1.0, 1.0).asin());
        Self { camera, yaw, pitch: pitch.clamp(-STEEPEST, STEEPEST), speed: (reach_m * 0.1).clamp(0.01, 1e4) }
    }

    pub(super) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Turns by as many points as the pointer was dragged to the right and down.
    pub(super) fn turn(&mut self, right: f64, down: f64) {
        self.yaw -= right * RADIANS_PER_POINT;
        self.pitch = (self.pitch - down * RADIANS_PER_POINT).clamp(-STEEPEST, STEEPEST);
        self.place(self.camera.position_world());
    }

    /// Flies for some seconds, and tells whether it moved.
    pub(super) fn go(&mut self, steer: Steer, seconds: f64) -> bool {
        let way = DVec3::new(steer.right, steer.up, -steer.ahead);
        if way == DVec3::ZERO {
            return false;
        }
        let speed = if steer.fast { self.speed * 5.0 } else { self.speed };
        // A frame that took long is no jump.
        let step = self.rotation() * way.normalize() * speed * seconds.min(0.25);
        self.place(self.camera.position_world() + step);
        true
    }

    fn rotation(&self) -> DQuat {
        DQuat::from_rotation_y(self.yaw) * DQuat::from_rotation_x(self.pitch)
    }

    fn place(&mut self, position: DVec3) {
        self.camera.world_from_view = DAffine3::from_rotation_translation(self.rotation(), position);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowgraph::scene::Projection;

    fn fly(eye: DVec3, target: DVec3) -> Fly {
        let projection = Projection::Perspective { fov_y: 0.8, near: 0.1, far: None };
        Fly::new(Camera::look_at(eye, target, DVec3::Y, projection), 100.0)
    }

    #[test]
    fn it_starts_as_the_camera_looks() {
        let mut fly = fly(DVec3::new(3.0, 2.0, 5.0), DVec3::new(-1.0, 0.5, -2.0));
        let before = fly.camera().forward_world();
        fly.turn(0.0, 0.0);
        assert!(fly.camera().forward_world().abs_diff_eq(before, 1e-9));
    }

    #[test]
    fn it_flies_where_it_looks_and_to_the_side() {
        let mut fly = fly(DVec3::ZERO, -DVec3::Z);
        assert!(fly.go(Steer { ahead: 1.0, ..Steer::default() }, 0.1));
        assert!(fly.camera().position_world().abs_diff_eq(DVec3::new(0.0, 0.0, -1.0), 1e-9));
        fly.go(Steer { right: 1.0, fast: true, ..Steer::default() }, 0.1);
        assert!(fly.camera().position_world().abs_diff_eq(DVec3::new(5.0, 0.0, -1.0), 1e-9));
        assert!(!fly.go(Steer::default(), 0.1));
    }

    #[test]
    fn it_turns_but_never_over() {
        let mut fly = fly(DVec3::ZERO, -DVec3::Z);
        fly.turn(-FRAC_PI_2 / RADIANS_PER_POINT, 0.0);
        assert!(fly.camera().forward_world().abs_diff_eq(-DVec3::X, 1e-9), "{:?}", fly.camera());
        fly.turn(0.0, 1e6);
        assert!(
            fly.camera().forward_world().y < -0.99 && fly.camera().world_from_view.matrix3.y_axis.y > 0.0
        );
    }
}
