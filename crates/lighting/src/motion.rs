//! The motion of cameras from frame to frame.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use glam::{DMat4, DVec3};
use shadowgraph_scene::{Camera, Projection};

/// The camera of one frame, without jitter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CameraState {
    clip_from_view: DMat4,
    view_from_world: DMat4,
    position_world: DVec3,
    orthographic: bool,
}

impl CameraState {
    fn new(camera: &Camera, aspect: f64) -> Self {
        Self {
            clip_from_view: camera.clip_from_view(aspect),
            view_from_world: camera.view_from_world(),
            position_world: camera.position_world(),
            orthographic: matches!(camera.projection, Projection::Orthographic { .. }),
        }
    }

    /// Returns the matrix from positions relative to `point_world` to clip space.
    fn clip_from_relative(&self, point_world: DVec3) -> DMat4 {
        self.clip_from_view * self.view_from_world * DMat4::from_translation(point_world)
    }
}

/// The camera of a view in this frame and in the view's previous frame, without jitter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraMotion {
    current: CameraState,
    previous: CameraState,
}

impl CameraMotion {
    /// Describes a camera that stands still, for images of this aspect ratio (width over height).
    pub fn still(camera: &Camera, aspect: f64) -> Self {
        let current = CameraState::new(camera, aspect);
        Self { current, previous: current }
    }

    /// Returns the position of the camera in this frame, metres.
    pub(crate) fn position_world(&self) -> DVec3 {
        self.current.position_world
    }

    /// Returns what has to be added to depth of the previous frame for a value inversely proportional to view depth. Of an
    /// orthographic camera there is none; with 1, it changes by the same amount as depth.
    pub(crate) fn depth_offset(&self) -> f64 {
        let projection = self.previous.clip_from_view;
        if self.previous.orthographic { 1.0 } else { projection.z_axis.z }
    }

    /// Returns the matrices from positions relative to `point_world` to clip space, of this frame and of the previous one.
    pub(crate) fn clip_from_relative(&self, point_world: DVec3) -> [DMat4; 2] {
        [self.current, self.previous].map(|camera| camera.clip_from_relative(point_world))
    }

    /// Returns the matrix from this frame's clip space to that of the previous frame.
    pub(crate) fn previous_from_current(&self) -> DMat4 {
        let [current, previous] = self.clip_from_relative(DVec3::ZERO);
        if previous == current { DMat4::IDENTITY } else { previous * current.inverse() }
    }

    /// Returns the matrix from this frame's clip space to that of the previous frame for what is infinitely far: cameras move by
    /// their rotation alone.
    pub(crate) fn background_previous_from_current(&self) -> DMat4 {
        if self.previous == self.current {
            return DMat4::IDENTITY;
        }
        let [current, previous] =
            [self.current, self.previous].map(|camera| camera.clip_from_relative(camera.position_world));
        previous * current.inverse()
    }
}

/// The cameras of several views in their latest frames.
#[derive(Debug, Default)]
pub struct PreviousCameras(Mutex<BTreeMap<u32, CameraState>>);

impl PreviousCameras {
    /// Returns the motion of the camera of view number `view` since the view's latest frame; none in its first frame.
    pub fn motion(&self, view: u32, camera: &Camera, aspect: f64) -> CameraMotion {
        let still = CameraMotion::still(camera, aspect);
        let cameras = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        CameraMotion { previous: cameras.get(&view).copied().unwrap_or(still.current), ..still }
    }

    /// Keeps the camera of a view's frame for the next frame.
    pub fn set(&self, view: u32, camera: &Camera, aspect: f64) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(view, CameraState::new(camera, aspect));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(eye: DVec3, target: DVec3) -> Camera {
        Camera::look_at(eye, target, DVec3::Y, Projection::Perspective { fov_y: 1.0, near: 0.1, far: None })
    }

    #[test]
    fn each_view_moves_from_its_own_latest_frame() {
        let cameras = PreviousCameras::default();
        let (first, second) = (camera(DVec3::X, DVec3::ZERO), camera(DVec3::Z, DVec3::ZERO));
        assert_eq!(cameras.motion(0, &first, 2.0), CameraMotion::still(&first, 2.0));
        cameras.set(0, &first, 2.0);
        cameras.set(1, &second, 2.0);
        assert_eq!(cameras.motion(0, &second, 2.0).previous, CameraState::new(&first, 2.0));
        assert_eq!(cameras.motion(1, &second, 2.0), CameraMotion::still(&second, 2.0));
    }

    #[test]
    fn the_background_follows_rotation_and_not_translation() {
        let at = |eye: DVec3, yaw: f64| camera(eye, eye + DVec3::new(yaw.sin(), 0.0, -yaw.cos()));
        let moved = |camera: &Camera| {
            let cameras = PreviousCameras::default();
            cameras.set(0, &at(DVec3::ZERO, 0.0), 1.0);
            let matrix = cameras.motion(0, camera, 1.0).background_previous_from_current();
            let clip = matrix * DVec3::new(0.2, -0.3, 1.0).extend(1.0);
            (clip.truncate() / clip.w).truncate()
        };
        let still = glam::DVec2::new(0.2, -0.3);
        assert!(moved(&at(DVec3::new(3.0, 1.0, -2.0), 0.0)).distance(still) < 1e-12);
        assert!(moved(&at(DVec3::ZERO, 0.1)).distance(still) > 0.1);
    }
}
