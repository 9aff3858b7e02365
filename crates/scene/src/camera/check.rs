//! Validation of cameras.

use super::{Camera, Projection};

/// The reason why a camera is invalid.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// The transform has values that are not finite.
    #[error("the camera's transform must have finite values")]
    Transform,
    /// The field of view is out of range.
    #[error("the camera's vertical field of view is {0} radians; it must be above 0 and below pi")]
    FieldOfView(f64),
    /// The orthographic view has no size.
    #[error(
        "the camera's half width is {half_width} m and its half height {half_height} m; both must be above 0"
    )]
    HalfSize {
        /// Half width, metres.
        half_width: f64,
        /// Half height, metres.
        half_height: f64,
    },
    /// The near plane is behind the camera or not finite.
    #[error("the camera's near plane is at {0} m; it must be finite, and above 0 in perspective")]
    Near(f64),
    /// The far plane is not beyond the near plane.
    #[error("the camera's far plane is at {far} m; it must be beyond its near plane, at {near} m")]
    Far {
        /// Distance of the near plane, metres.
        near: f64,
        /// Distance of the far plane, metres.
        far: f64,
    },
    /// The aspect ratio of the image is out of range.
    #[error("the image's aspect ratio is {0}; it must be finite and above 0")]
    Aspect(f64),
}

impl Camera {
    /// Checks that the camera can render an image of the aspect ratio `aspect` (width over height).
    ///
    /// # Errors
    /// Names the first value that is out of its documented range.
    ///
    /// ```
    /// use shadowgraph_scene::{Camera, CameraError, Projection};
    /// use glam::DVec3;
    /// let projection = Projection::Perspective { fov_y: 0.8, near: 5.0, far: Some(1.0) };
    /// let camera = Camera::look_at(DVec3::Z, DVec3::ZERO, DVec3::Y, projection);
    /// assert_eq!(camera.check(1.5), Err(CameraError::Far { near: 5.0, far: 1.0 }));
    /// ```
    pub fn check(&self, aspect: f64) -> Result<(), CameraError> {
        let is_size = |size: f64| size.is_finite() && size > 0.0;
        if !self.world_from_view.is_finite() {
            return Err(CameraError::Transform);
        }
        let near = self.near();
        match self.projection {
            Projection::Perspective { fov_y, .. } if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) => {
                return Err(CameraError::FieldOfView(fov_y));
            }
            Projection::Perspective { .. } if !is_size(near) => return Err(CameraError::Near(near)),
            Projection::Orthographic { half_width, half_height, .. }
                if !(is_size(half_width) && is_size(half_height)) =>
            {
                return Err(CameraError::HalfSize { half_width, half_height });
            }
            Projection::Orthographic { .. } if !near.is_finite() => return Err(CameraError::Near(near)),
            _ => {}
        }
        if let Some(far) = self.far().filter(|far| !(far.is_finite() && *far > near)) {
            return Err(CameraError::Far { near, far });
        }
        if is_size(aspect) { Ok(()) } else { Err(CameraError::Aspect(aspect)) }
    }
}
