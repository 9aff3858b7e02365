//! Punctual lights, as glTF's KHR_lights_punctual has them.

use glam::{DAffine3, DVec3, Vec3};
use serde::{Deserialize, Serialize};

/// The illuminance, lux, below which a spot or point light without a range is treated as having no effect.
pub const MIN_ILLUMINANCE_LX: f64 = 0.01;

/// A punctual light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// The name in the file, if it has one.
    pub name: Option<String>,
    /// The kind of the light, and its transform.
    pub kind: LightKind,
    /// Linear RGB, each 0 or more, usually up to 1.
    pub color: Vec3,
    /// Lux for directional lights, candela for spot and point lights; 0 or more.
    pub intensity: f32,
    /// Whether the light casts shadows.
    pub casts_shadow: bool,
}

/// The kind of a light and its transform in the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum LightKind {
    /// A light infinitely far away.
    Directional {
        /// The direction in which the light travels, unit length.
        direction: DVec3,
    },
    /// A cone of light.
    Spot {
        /// The tip of the cone, metres.
        position_world: DVec3,
        /// The axis of the cone, the direction in which the light travels, unit length.
        direction: DVec3,
        /// The distance where the light ends, metres; `None`: unlimited.
        range: Option<f64>,
        /// Half angle of the fully lit cone, radians, 0 up to `outer_angle`.
        inner_angle: f64,
        /// Half angle of the whole cone, radians, above 0 up to π/2.
        outer_angle: f64,
    },
    /// A light that shines in all directions.
    Point {
        /// The centre, metres.
        position_world: DVec3,
        /// The distance where the light ends, metres; `None`: unlimited.
        range: Option<f64>,
    },
}

impl LightKind {
    /// Returns the rank of the kind in a scene's light list: directional 0, spot 1, point 2.
    #[must_use]
    pub fn order(&self) -> u8 {
        match self {
            Self::Directional { .. } => 0,
            Self::Spot { .. } => 1,
            Self::Point { .. } => 2,
        }
    }

    /// Returns the light at a node: at its origin, travelling along its -Z. Where the node has no direction, because its scale is 0,
    /// the light keeps its own.
    #[must_use]
    pub fn at_node(mut self, world_from_node: &DAffine3) -> Self {
        if let Self::Spot { position_world, .. } | Self::Point { position_world, .. } = &mut self {
            *position_world = world_from_node.translation;
        }
        if let Self::Directional { direction } | Self::Spot { direction, .. } = &mut self {
            *direction = (-world_from_node.matrix3.z_axis).try_normalize().unwrap_or(*direction);
        }
        self
    }
}

impl Light {
    /// Creates a white directional light that casts shadows, from the direction in which it travels (any length) and its
    /// illuminance in lux (full sunlight is about 100,000).
    ///
    /// ```
    /// use glam::DVec3;
    /// use shadowgraph_scene::Light;
    /// assert!(Light::sun(DVec3::new(-1.0, -2.0, -0.5), 100_000.0).is_usable());
    /// ```
    #[must_use]
    pub fn sun(direction: DVec3, lux: f32) -> Self {
        let kind = LightKind::Directional { direction: direction.normalize_or(DVec3::NEG_Y) };
        Self { name: None, kind, color: Vec3::ONE, intensity: lux, casts_shadow: true }
    }

    /// Returns the range of the light, metres; `None` for directional lights.
    ///
    /// That is its `range`, else the distance at which its illuminance falls below
    /// [`MIN_ILLUMINANCE_LX`].
    ///
    /// ```
    /// use glam::{DVec3, Vec3};
    /// use shadowgraph_scene::{Light, LightKind};
    /// let kind = LightKind::Point { position_world: DVec3::ZERO, range: None };
    /// let light = Light { name: None, kind, color: Vec3::ONE, intensity: 100.0, casts_shadow: true };
    /// assert_eq!(light.effective_range(), Some(100.0));
    /// ```
    #[must_use]
    pub fn effective_range(&self) -> Option<f64> {
        let range = match self.kind {
            LightKind::Directional { .. } => return None,
            LightKind::Spot { range, .. } | LightKind::Point { range, .. } => range,
        };
        let candela = f64::from(self.intensity) * f64::from(self.color.max_element());
        Some(range.unwrap_or_else(|| (candela.max(0.0) / MIN_ILLUMINANCE_LX).sqrt()))
    }

    /// Returns whether all values are in their documented ranges, except that the direction may have any length above 0. A
    /// light that is not usable gives no light.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        let is_positive = |value: f64| value.is_finite() && value > 0.0;
        let is_range = |range: Option<f64>| range.is_none_or(is_positive);
        let is_non_negative = |value: f32| value.is_finite() && value >= 0.0;
        let has_valid_kind = match self.kind {
            LightKind::Directional { direction } => direction.try_normalize().is_some(),
            LightKind::Spot { position_world, direction, range, inner_angle, outer_angle } => {
                position_world.is_finite()
                    && direction.try_normalize().is_some()
                    && is_range(range)
                    && inner_angle.is_finite()
                    && is_positive(outer_angle)
            }
            LightKind::Point { position_world, range } => position_world.is_finite() && is_range(range),
        };
        has_valid_kind
            && is_non_negative(self.intensity)
            && self.color.to_array().into_iter().all(is_non_negative)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn light(kind: LightKind) -> Light {
        Light { name: None, kind, color: Vec3::new(0.25, 0.5, 0.0), intensity: 8.0, casts_shadow: true }
    }

    #[test]
    fn a_given_range_is_the_effective_range() {
        let kind = LightKind::Point { position_world: DVec3::ZERO, range: Some(3.0) };
        assert_eq!(light(kind).effective_range(), Some(3.0));
    }

    #[test]
    fn without_a_range_the_effective_range_follows_from_the_intensity() {
        let kind = LightKind::Spot {
            position_world: DVec3::ZERO,
            direction: DVec3::NEG_Y,
            range: None,
            inner_angle: 0.0,
            outer_angle: 0.5,
        };
        // The brightest channel has 4 candela, which is 0.01 lux at 20 m.
        assert_eq!(light(kind).effective_range(), Some(20.0));
        assert_eq!(Light { intensity: 0.0, ..light(kind) }.effective_range(), Some(0.0));
    }

    #[test]
    fn a_light_is_usable_if_all_its_values_are() {
        let spot = |position_world, direction, range, outer_angle| LightKind::Spot {
            position_world,
            direction,
            range,
            inner_angle: 0.1,
            outer_angle,
        };
        let point = |position_world, range| LightKind::Point { position_world, range };
        let sun = |direction| LightKind::Directional { direction };
        let usable = |kind| light(kind).is_usable();
        assert!(usable(sun(DVec3::new(1.0, -3.0, 2.0))));
        assert!(usable(spot(DVec3::ONE, DVec3::NEG_Y, None, 0.5)) && usable(point(DVec3::ONE, Some(2.0))));
        assert!(!usable(sun(DVec3::ZERO)) && !usable(sun(DVec3::NAN)));
        assert!(!usable(spot(DVec3::NAN, DVec3::NEG_Y, None, 0.5)));
        assert!(!usable(spot(DVec3::ONE, DVec3::ZERO, None, 0.5)));
        assert!(!usable(spot(DVec3::ONE, DVec3::NEG_Y, None, 0.0)));
        for range in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(!usable(point(DVec3::ONE, Some(range))), "{range}");
        }
        for intensity in [-1.0, f32::NAN, f32::INFINITY] {
            assert!(!Light { intensity, ..light(sun(DVec3::NEG_Y)) }.is_usable(), "{intensity}");
        }
        let color = Vec3::new(1.0, -0.1, 0.0);
        assert!(!Light { color, ..light(sun(DVec3::NEG_Y)) }.is_usable());
    }

    #[test]
    fn directional_lights_reach_everywhere() {
        assert_eq!(light(LightKind::Directional { direction: DVec3::NEG_Y }).effective_range(), None);
    }
}
