//! The axes of light space.

use glam::{DMat3, DVec3};

/// Absolute cosine to the vertical above which a light's up axis is computed from the world's -Z instead of +Y.
const STEEP: f64 = 0.999;

/// Returns the rotation from world to light space: +Z towards the light, +Y as close to the world's up as possible
/// (the world's -Z for lights from straight above or below). It depends only on the direction, so it
/// is constant while the camera moves. `None` for a direction that is zero or not finite.
///
/// ```
/// use glam::DVec3;
/// use shadowgraph_shadows::light_from_world;
/// let rotation = light_from_world(DVec3::NEG_Y).ok_or("no direction")?;
/// assert_eq!(rotation * DVec3::Y, DVec3::Z);
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn light_from_world(direction: DVec3) -> Option<DMat3> {
    let towards_light = -direction.try_normalize()?;
    let up = if towards_light.y.abs() > STEEP { DVec3::NEG_Z } else { DVec3::Y };
    let right = up.cross(towards_light).try_normalize()?;
    // Rows of the result: a transposed matrix of the axes is its inverse, exactly.
    Some(DMat3::from_cols(right, towards_light.cross(right), towards_light).transpose())
}
