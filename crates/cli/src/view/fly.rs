//! A fly camera.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DQuat, DVec3};

use shadowgraph::scene::Camera;

/// Rotation per point that the pointer is dragged, radians.
const RADIANS_PER_POINT: f64 = 0.005;
/// Maximum pitch, radians.
const STEEPEST: f64 = FRAC_PI_2 - 0.01;

/// A fly camera with its speed.
#[derive(Clone, Debug)]
pub(super) struct FlyCamera {
    camera: Camera,
    yaw: f64,
    pitch: f64,
    /// Speed, metres per second.
    pub(super) speed: f64,
}

/// Directions of movement, each -1 to 1: right, up, ahead.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FlyInput {
    pub(super) right: f64,
    pub(super) up: f64,
    pub(super) ahead: f64,
    pub(super) fast: bool,
}

impl FlyCamera {
    /// Starts at a camera; `scene_radius_m` is the approximate radius of the scene.
    pub(super) fn new(camera: Camera, scene_radius_m: f64) -> Self {
        let ahead = camera.forward_world();
        let (yaw, pitch) = ((-ahead.x).atan2(-ahead.z), ahead.y.clamp(-1.0, 1.0).asin());
        Self {
            camera,
            yaw,
            pitch: pitch.clamp(-STEEPEST, STEEPEST),
            speed: (scene_radius_m * 0.1).clamp(0.01, 1e4),
        }
    }

    pub(super) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Rotates by the number of points that the pointer was dragged to the right and down.
    pub(super) fn turn(&mut self, right: f64, down: f64) {
        self.yaw -= right * RADIANS_PER_POINT;
        self.pitch = (self.pitch - down * RADIANS_PER_POINT).clamp(-STEEPEST, STEEPEST);
        self.set_position(self.camera.position_world());
    }

    /// Moves for some seconds, and returns whether the camera moved.
    pub(super) fn update(&mut self, input: FlyInput, seconds: f64) -> bool {
        let direction = DVec3::new(input.right, input.up, -input.ahead);
        if direction == DVec3::ZERO {
            return false;
        }
        let speed = if input.fast { self.speed * 5.0 } else { self.speed };
        // Limits the step after a long frame.
        let step = self.rotation() * direction.normalize() * speed * seconds.min(0.25);
        self.set_position(self.camera.position_world() + step);
        true
    }

    fn rotation(&self) -> DQuat {
        DQuat::from_rotation_y(self.yaw) * DQuat::from_rotation_x(self.pitch)
    }

    fn set_position(&mut self, position: DVec3) {
        self.camera.world_from_view = DAffine3::from_rotation_translation(self.rotation(), position);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shadowgraph::scene::Projection;

    fn fly(eye: DVec3, target: DVec3) -> FlyCamera {
        let projection = Projection::Perspective { fov_y: 0.8, near: 0.1, far: None };
        FlyCamera::new(Camera::look_at(eye, target, DVec3::Y, projection), 100.0)
    }

    #[test]
    fn it_starts_in_the_direction_of_the_camera() {
        let mut fly = fly(DVec3::new(3.0, 2.0, 5.0), DVec3::new(-1.0, 0.5, -2.0));
        let before = fly.camera().forward_world();
        fly.turn(0.0, 0.0);
        assert!(fly.camera().forward_world().abs_diff_eq(before, 1e-9));
    }

    #[test]
    fn it_moves_forwards_and_to_the_side() {
        let mut fly = fly(DVec3::ZERO, -DVec3::Z);
        assert!(fly.update(FlyInput { ahead: 1.0, ..FlyInput::default() }, 0.1));
        assert!(fly.camera().position_world().abs_diff_eq(DVec3::new(0.0, 0.0, -1.0), 1e-9));
        fly.update(FlyInput { right: 1.0, fast: true, ..FlyInput::default() }, 0.1);
        assert!(fly.camera().position_world().abs_diff_eq(DVec3::new(5.0, 0.0, -1.0), 1e-9));
        assert!(!fly.update(FlyInput::default(), 0.1));
    }

    #[test]
    fn it_never_turns_upside_down() {
        let mut fly = fly(DVec3::ZERO, -DVec3::Z);
        fly.turn(-FRAC_PI_2 / RADIANS_PER_POINT, 0.0);
        assert!(fly.camera().forward_world().abs_diff_eq(-DVec3::X, 1e-9), "{:?}", fly.camera());
        fly.turn(0.0, 1e6);
        assert!(
            fly.camera().forward_world().y < -0.99 && fly.camera().world_from_view.matrix3.y_axis.y > 0.0
        );
    }
}
