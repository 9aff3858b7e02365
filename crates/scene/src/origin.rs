//! The floating origin: GPU space is relative to a point near the camera.

use glam::DVec3;

/// The spacing of the grid of possible origins of GPU space, metres.
pub const ORIGIN_GRID_M: f64 = 1024.0;

/// The maximum distance from the world's origin of files and of what animations move, metres.
pub(crate) const MAX_WORLD_M: f64 = 1e15;

/// Returns the grid point nearest to `position_world`, so that f32 offsets from it stay small.
///
/// The result changes only when the position crosses into another grid cell. A position that is not
/// finite gives the world's origin.
///
/// ```
/// use glam::DVec3;
/// use shadowgraph_scene::origin_near;
/// assert_eq!(origin_near(DVec3::new(100.0, 2.0, -700.0)), DVec3::new(0.0, 0.0, -1024.0));
/// ```
#[must_use]
pub fn origin_near(position_world: DVec3) -> DVec3 {
    if !position_world.is_finite() {
        return DVec3::ZERO;
    }
    // Adding zero turns -0.0 into 0.0, so that equal origins also print equally.
    (position_world / ORIGIN_GRID_M).round() * ORIGIN_GRID_M + DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origin_stays_within_half_a_cell_of_the_position() {
        for x in [-5000.3, -512.1, 0.0, 511.9, 513.0, 1.0e7] {
            let position = DVec3::new(x, -x, 0.5 * x);
            let offset = (origin_near(position) - position).abs();
            assert!(offset.max_element() <= ORIGIN_GRID_M / 2.0, "{position}");
        }
    }

    #[test]
    fn origin_of_a_position_that_is_not_finite_is_zero() {
        assert_eq!(origin_near(DVec3::new(f64::NAN, 0.0, 0.0)), DVec3::ZERO);
        assert_eq!(origin_near(DVec3::new(0.0, f64::INFINITY, 0.0)), DVec3::ZERO);
    }
}
