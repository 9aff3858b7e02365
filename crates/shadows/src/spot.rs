//! The pyramid that a spot light's tile covers.

use glam::{DMat3, DMat4, DVec3, DVec4};
use shadowgraph_scene::{BoundingSphere, ConvexVolume, Plane};

/// The cone of a spot light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotCone {
    /// The tip, metres.
    pub position_world: DVec3,
    /// The direction in which the light travels, unit length.
    pub direction: DVec3,
    /// Half of the cone's angle, radians, above 0.
    pub half_angle: f64,
    /// Range of the light, metres, above 0.
    pub range_m: f64,
}

/// The widest half angle, radians (80 degrees), that one tile covers with a useful resolution. The area
/// outside, at the rim of a wider cone, is lit.
pub const MAX_SPOT_HALF_ANGLE: f64 = 1.396;

impl SpotCone {
    /// Returns a small bounding sphere of the lit volume.
    #[must_use]
    pub fn bounding_sphere(&self) -> BoundingSphere {
        let (sin, cos) = self.half_angle.sin_cos();
        // A narrow cone touches its sphere with tip and rim, a wide one with the rim as the equator.
        let (along, radius_m) = if self.half_angle > std::f64::consts::FRAC_PI_4 {
            (self.range_m * cos, self.range_m * sin)
        } else {
            let radius = self.range_m * 0.5 / cos;
            (radius, radius)
        };
        BoundingSphere { center_world: self.position_world + self.direction * along, radius_m }
    }
}

/// A square pyramid with its tip at a spot light, wide enough that the cone stays away from the tile's edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotFit {
    /// The light.
    pub cone: SpotCone,
    /// The rotation from world to light space, +Z against the light's direction.
    pub light_from_world: DMat3,
    /// The tangent of half the angle that the tile covers, with its border.
    pub tan_half: f64,
    /// Distance along the axis with depth 1, metres.
    pub near_m: f64,
    /// Distance along the axis with depth 0, metres.
    pub far_m: f64,
    /// The width of the tile, pixels.
    pub tile_px: u32,
}

impl SpotFit {
    /// Fits the pyramid: the cone stays `margin_px` (below half of `tile_px`) inside the tile.
    /// `light_from_world` is the [rotation](crate::light_from_world) for the cone's direction. `near_m` is
    /// limited to half of the range.
    #[must_use]
    pub fn new(cone: SpotCone, light_from_world: DMat3, near_m: f64, tile_px: u32, margin_px: f64) -> Self {
        let half_px = f64::from(tile_px) * 0.5;
        let tan_half = cone.half_angle.min(MAX_SPOT_HALF_ANGLE).tan() * half_px / (half_px - margin_px);
        let near_m = near_m.min(cone.range_m * 0.5);
        Self { cone, light_from_world, tan_half, near_m, far_m: cone.range_m, tile_px }
    }

    /// Returns the matrix from world space relative to `origin_world` to the tile: x right and y up from -w to w, z/w
    /// 1 at `near_m` and 0 at `far_m`; w is the distance along the axis.
    #[must_use]
    pub fn clip_from_world(&self, origin_world: DVec3) -> DMat4 {
        let Self { near_m, far_m, tan_half, .. } = *self;
        let scale = near_m / (far_m - near_m);
        let projection = DMat4::from_cols(
            DVec4::X / tan_half,
            DVec4::Y / tan_half,
            DVec4::new(0.0, 0.0, scale, -1.0),
            DVec4::Z * (scale * far_m),
        );
        let to_tip = DMat4::from_translation(origin_world - self.cone.position_world);
        projection * DMat4::from_mat3(self.light_from_world) * to_tip
    }

    /// Returns the factor c, metres, in z/w = c / distance + constant.
    #[must_use]
    pub fn depth_scale_m(&self) -> f64 {
        self.near_m * self.far_m / (self.far_m - self.near_m)
    }

    /// Returns the width of a texel at 1 m along the axis, metres.
    #[must_use]
    pub fn texel_per_m(&self) -> f64 {
        2.0 * self.tan_half / f64::from(self.tile_px)
    }

    /// Returns the volume whose casters matter: the pyramid from its tip to the end of the light's range.
    #[must_use]
    pub fn cull_volume(&self) -> ConvexVolume {
        let world_from_light = self.light_from_world.transpose();
        let tip = self.cone.position_world;
        let side = |inward: DVec3| {
            let normal = world_from_light * (inward + DVec3::NEG_Z * self.tan_half).normalize();
            Plane::through(tip, normal)
        };
        let mut planes: Vec<Plane> =
            [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y].into_iter().map(side).collect();
        let backwards = world_from_light.z_axis;
        planes.push(Plane::through(tip - backwards * self.far_m, backwards));
        ConvexVolume { planes }
    }
}
