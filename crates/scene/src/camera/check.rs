//! Cameras that see something.

use super::{Camera, Projection};

/// Why a camera sees nothing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// Its placement has values that are not finite.
    #[error("the camera's placement is not made of finite numbers")]
    Placement,
    /// Its angle is no angle.
    #[error("the camera's vertical angle is {0} radians; it must be above 0 and below pi")]
    FieldOfView(f64),
    /// Its box has no size.
    #[error(
        "the camera sees half a width of {half_width} m and half a height of {half_height} m; both must be above 0"
    )]
    HalfSize {
        /// Metres.
        half_width: f64,
        /// Metres.
        half_height: f64,
    },
    /// Its near plane is behind it, or nowhere.
    #[error("the camera's near plane is at {0} m; it must be a number, in perspective above 0")]
    Near(f64),
    /// Its far plane is not beyond its near plane.
    #[error("the camera's far plane is at {far} m; it must be beyond its near plane, at {near} m")]
    Far {
        /// Metres.
        near: f64,
        /// Metres.
        far: f64,
    },
    /// The picture has no shape.
    #[error("the picture's width over its height is {0}; it must be a number above 0")]
    Aspect(f64),
}

impl Camera {
    /// Checks that there is something to see in a picture of the shape `aspect` (width over height).
    ///
    /// # Errors
    /// The first value that is not as its documentation says.
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
            return Err(CameraError::Placement);
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
