//! The brightness of a scene: its key light, its ambient light and its exposure.

use glam::Vec3;
use shadowgraph_scene::{Aabb, Light, LightKind};

/// The illuminance of a scene by its light sources, lux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeyLight {
    /// The sum of the directional lights.
    pub directional_lx: f32,
    /// The sum of the spot and point lights, at the median of the objects that they light.
    pub local_lx: f32,
}

/// The maximum number of objects that are sampled.
const MAX_OBJECTS: usize = 4_096;

impl KeyLight {
    /// Estimates the key light of objects with these bounds, ignoring shadows.
    pub fn estimate(lights: &[Light], objects: &[Aabb]) -> Self {
        let lights: Vec<&Light> = lights.iter().filter(|light| light.is_usable()).collect();
        let strength = |light: &&Light| f64::from(light.intensity) * f64::from(light.color.max_element());
        let is_sun = |light: &&&Light| matches!(light.kind, LightKind::Directional { .. });
        let directional_lx = lights.iter().filter(is_sun).map(strength).sum::<f64>() as f32;
        let stride = objects.len().div_ceil(MAX_OBJECTS).max(1);
        let objects = objects.iter().step_by(stride).filter(|object| !object.is_empty());
        let mut illuminances: Vec<f64> = objects
            .map(|object| lights.iter().map(|light| strength(light) * local_illuminance(light, object)).sum())
            .filter(|illuminance: &f64| *illuminance > 0.0)
            .collect();
        illuminances.sort_by(f64::total_cmp);
        let local_lx = illuminances.get(illuminances.len() / 2).map_or(0.0, |middle| *middle as f32);
        Self { directional_lx, local_lx }
    }

    /// Returns the illuminance by ambient light that the lights cause, lux: spot and point lights contribute little to it.
    pub fn ambient_lx(&self) -> f32 {
        (self.directional_lx + LOCAL_AMBIENT_FRACTION * self.local_lx).max(MIN_LX)
    }
}

/// Returns the illuminance of an object by a spot or point light of one candela, lux.
fn local_illuminance(light: &Light, object: &Aabb) -> f64 {
    let (position_world, cone) = match light.kind {
        LightKind::Directional { .. } => return 0.0,
        LightKind::Point { position_world, .. } => (position_world, None),
        LightKind::Spot { position_world, direction, outer_angle, .. } => {
            (position_world, Some((direction, outer_angle)))
        }
    };
    let to_object = object.center() - position_world;
    // Large objects are not lit at their centre.
    let distance = to_object.length().max(object.radius()).max(0.05);
    let in_range = light.effective_range().is_none_or(|range| distance < range);
    let in_cone = cone.is_none_or(|(direction, outer_angle)| {
        let inside = object.contains_point(position_world) || to_object.length() < object.radius();
        inside || to_object.normalize_or_zero().dot(direction) > outer_angle.cos()
    });
    if in_range && in_cone { 1.0 / (distance * distance) } else { 0.0 }
}

/// The ambient light of a scene, and its exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientLight {
    /// Radiance of the sky straight above, linear RGB.
    pub sky: Vec3,
    /// Radiance of the ground straight below, linear RGB.
    pub ground: Vec3,
    /// The factor of radiance before tonemapping.
    pub exposure: f32,
}

impl AmbientLight {
    /// Chooses an exposure at which white in the full key light is slightly below white in the image, and a sky and
    /// ground that fill shadows with some of the light. The sky follows the directional lights: spot and point lights
    /// contribute little to it.
    ///
    /// ```
    /// use shadowgraph_lighting::{AmbientLight, KeyLight};
    /// let day = AmbientLight::for_key_light(KeyLight { directional_lx: 100_000.0, local_lx: 50.0 });
    /// let night = AmbientLight::for_key_light(KeyLight { directional_lx: 0.3, local_lx: 50.0 });
    /// assert!(day.exposure < night.exposure && day.sky.x > night.sky.x);
    /// ```
    pub fn for_key_light(key: KeyLight) -> Self {
        let KeyLight { directional_lx, local_lx } = key;
        // The radiance of white in one lux.
        let white = std::f32::consts::FRAC_1_PI;
        let ambient = key.ambient_lx() * white;
        Self {
            sky: Vec3::new(0.80, 0.95, 1.20) * (ambient * 0.20),
            ground: Vec3::new(1.05, 0.95, 0.85) * (ambient * 0.08),
            exposure: 1.5 / (directional_lx.max(local_lx).max(MIN_LX) * white),
        }
    }

    /// Returns the colour of the sky in a lit pass: scene-linear, exposure applied.
    pub fn background(&self) -> [f64; 4] {
        let [red, green, blue] = (self.sky * self.exposure).as_dvec3().to_array();
        [red, green, blue, 1.0]
    }
}

/// The fraction of the light of spot and point lights that becomes ambient light.
const LOCAL_AMBIENT_FRACTION: f32 = 0.2;
/// The minimum illuminance for which exposure is computed, lux.
const MIN_LX: f32 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn light(kind: LightKind, intensity: f32) -> Light {
        Light { name: None, kind, color: Vec3::ONE, intensity, casts_shadow: true }
    }

    #[test]
    fn directional_lights_add_up_and_point_lights_count_at_the_median_object() {
        let sun = light(LightKind::Directional { direction: DVec3::NEG_Y }, 5_000.0);
        let point =
            |intensity| light(LightKind::Point { position_world: DVec3::ZERO, range: None }, intensity);
        let object = |x: f64| Aabb { min: DVec3::new(x, -0.1, -0.1), max: DVec3::new(x + 0.2, 0.1, 0.1) };
        let key = KeyLight::estimate(
            &[sun.clone(), sun, point(40.0)],
            &[object(0.0), object(1.9), object(9.9), object(9.9), object(900.0)],
        );
        assert_eq!(key.directional_lx, 10_000.0);
        assert!((key.local_lx - 10.0).abs() < 0.1, "{key:?}");
    }

    #[test]
    fn a_point_light_inside_an_object_lights_it_from_at_least_its_radius() {
        let point = light(LightKind::Point { position_world: DVec3::ZERO, range: None }, 100.0);
        let object = Aabb { min: DVec3::splat(-5.0), max: DVec3::splat(5.0) };
        assert!(KeyLight::estimate(&[point], &[object]).local_lx < 2.0);
    }

    #[test]
    fn a_scene_without_light_has_a_finite_exposure() {
        let ambient_light = AmbientLight::for_key_light(KeyLight::estimate(&[], &[]));
        assert!(
            ambient_light.exposure.is_finite()
                && ambient_light.background().iter().all(|value| value.is_finite())
        );
    }
}
