//! Conversion of cameras.

use ::gltf::json;
use glam::DAffine3;
use json::camera::Type;
use json::validation::Checked;

use crate::camera::{Camera, Projection};

/// Converts the projection of a camera.
///
/// # Errors
/// The message says which value is out of range and what is allowed.
pub(super) fn projection(camera: &json::Camera) -> Result<Projection, String> {
    match (camera.type_, &camera.perspective, &camera.orthographic) {
        (Checked::Valid(Type::Perspective), Some(projection), _) => perspective(projection),
        (Checked::Valid(Type::Orthographic), _, Some(projection)) => orthographic(projection),
        (Checked::Valid(_), ..) => Err("has no parameters for its type".into()),
        (Checked::Invalid, ..) => Err("has an unknown type (allowed: perspective, orthographic)".into()),
    }
}

fn perspective(projection: &json::camera::Perspective) -> Result<Projection, String> {
    let (fov_y, near) = (f64::from(projection.yfov), f64::from(projection.znear));
    if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) {
        return Err(format!("yfov is {fov_y} (allowed: above 0 and below pi, radians)"));
    }
    if !(near > 0.0 && near.is_finite()) {
        return Err(format!("znear is {near} (allowed: above 0)"));
    }
    let far = projection.zfar.map(f64::from);
    match far {
        Some(far) if !(far > near && far.is_finite()) => {
            Err(format!("zfar is {far} (allowed: above znear, {near})"))
        }
        _ => Ok(Projection::Perspective { fov_y, near, far }),
    }
}

fn orthographic(projection: &json::camera::Orthographic) -> Result<Projection, String> {
    let (half_width, half_height) = (f64::from(projection.xmag).abs(), f64::from(projection.ymag).abs());
    let (near, far) = (f64::from(projection.znear), f64::from(projection.zfar));
    if !(half_width > 0.0 && half_width.is_finite() && half_height > 0.0 && half_height.is_finite()) {
        return Err(format!("xmag and ymag are {half_width} and {half_height} (allowed: not 0)"));
    }
    if !(near >= 0.0 && near.is_finite()) {
        return Err(format!("znear is {near} (allowed: 0 or more)"));
    }
    if !(far > near && far.is_finite()) {
        return Err(format!("zfar is {far} (allowed: above znear, {near})"));
    }
    Ok(Projection::Orthographic { half_width, half_height, near, far })
}

/// Creates the camera of a node; the scale of the node is ignored.
///
/// # Errors
/// The node's scale is 0, so that the camera has no direction.
pub(super) fn camera_at_node(
    projection: Projection,
    name: Option<String>,
    world: &DAffine3,
) -> Result<Camera, String> {
    match Camera::world_from_view_at_node(world) {
        Some(world_from_view) => Ok(Camera { name, world_from_view, projection }),
        None => Err("its camera has no direction: the scale must not be 0".into()),
    }
}
