//! The ground under a scene.

use glam::{DVec3, Vec3};

use crate::bounds::Aabb;
use crate::light::{Light, LightKind};

/// An endless horizontal plane under a scene, which receives shadows and ambient occlusion and fades into the horizon. It is part of
/// the background: drawn by pipelines with a sky, in the colour of the ground under that sky, and only in colour images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundPlane {
    /// Its height, metres.
    pub height_world: f64,
}

/// The length of shadows that the ground receives, in radii of what casts them.
const MAX_SHADOW_RADII: f64 = 4.0;

impl GroundPlane {
    /// The albedo of the ground under a sky, linear RGB: that of dry soil and concrete.
    pub const ALBEDO: Vec3 = Vec3::new(0.30, 0.28, 0.26);

    /// Returns the bounds of the shadows on the ground of everything within `casters`; empty for empty bounds. Shadows of a low sun
    /// end at four radii of `casters`.
    ///
    /// ```
    /// use glam::{DVec3, Vec3};
    /// use shadowgraph_scene::{Aabb, GroundPlane, Light, LightKind};
    /// let kind = LightKind::Directional { direction: DVec3::new(1.0, -1.0, 0.0).normalize() };
    /// let sun = Light { name: None, kind, color: Vec3::ONE, intensity: 1.0, casts_shadow: true };
    /// let tower = Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 8.0, 1.0) };
    /// let shadows = GroundPlane { height_world: 0.0 }.shadow_bounds(&tower, &[sun]);
    /// assert!((shadows.max - DVec3::new(9.0, 0.0, 1.0)).length() < 1e-9);
    /// ```
    #[must_use]
    pub fn shadow_bounds(&self, casters: &Aabb, lights: &[Light]) -> Aabb {
        if casters.is_empty() {
            return Aabb::EMPTY;
        }
        let reach = MAX_SHADOW_RADII * casters.radius();
        let on_ground = |corner: DVec3| DVec3 { y: self.height_world, ..corner };
        let directions = lights.iter().filter(|light| light.casts_shadow && light.is_usable()).map(|light| {
            match light.kind {
                LightKind::Directional { direction } => direction.normalize_or_zero(),
                LightKind::Spot { .. } | LightKind::Point { .. } => DVec3::NEG_Y,
            }
        });
        let corners = casters.corners();
        let shadows = directions.filter(|direction| direction.y < 0.0).flat_map(|direction| {
            corners.map(|corner| {
                let distance = ((self.height_world - corner.y) / direction.y).clamp(0.0, reach);
                on_ground(corner + direction * distance)
            })
        });
        Aabb::from_points(corners.map(on_ground).into_iter().chain(shadows))
    }
}
