//! How bright a scene is, and what light there is that no light source is counted for.

use glam::Vec3;
use shadowgraph_scene::{Aabb, Light, LightKind};

/// How much light a scene's light sources give where they matter, lux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeyLight {
    /// The directional lights together.
    pub directional_lx: f32,
    /// Spot and point lights together, on the middle one of the things that they light, from dim to bright.
    pub local_lx: f32,
}

/// Of more things than this only some are looked at.
const MAX_THINGS: usize = 4_096;

impl KeyLight {
    /// Estimates the key light of things within these bounds. Shadows are not looked at.
    pub fn estimate(lights: &[Light], things: &[Aabb]) -> Self {
        let lights: Vec<&Light> = lights.iter().filter(|light| light.is_usable()).collect();
        let strength = |light: &&Light| f64::from(light.intensity) * f64::from(light.color.max_element());
        let is_sun = |light: &&&Light| matches!(light.kind, LightKind::Directional { .. });
        let directional_lx = lights.iter().filter(is_sun).map(strength).sum::<f64>() as f32;
        let stride = things.len().div_ceil(MAX_THINGS).max(1);
        let things = things.iter().step_by(stride).filter(|thing| !thing.is_empty());
        let mut lit: Vec<f64> = things
            .map(|thing| lights.iter().map(|light| strength(light) * local_share(light, thing)).sum())
            .filter(|illuminance: &f64| *illuminance > 0.0)
            .collect();
        lit.sort_by(f64::total_cmp);
        let local_lx = lit.get(lit.len() / 2).map_or(0.0, |middle| *middle as f32);
        Self { directional_lx, local_lx }
    }
}

/// What a lamp of one candela gives on a thing, lux.
fn local_share(light: &Light, thing: &Aabb) -> f64 {
    let (position_world, cone) = match light.kind {
        LightKind::Directional { .. } => return 0.0,
        LightKind::Point { position_world, .. } => (position_world, None),
        LightKind::Spot { position_world, direction, outer_angle, .. } => {
            (position_world, Some((direction, outer_angle)))
        }
    };
    let way = thing.center() - position_world;
    // Large things are not lit at their middle.
    let distance = way.length().max(thing.radius()).max(0.05);
    let reached = light.effective_range().is_none_or(|range| distance < range);
    let in_cone = cone.is_none_or(|(direction, outer_angle)| {
        let inside = thing.contains_point(position_world) || way.length() < thing.radius();
        inside || way.normalize_or_zero().dot(direction) > outer_angle.cos()
    });
    if reached && in_cone { 1.0 / (distance * distance) } else { 0.0 }
}

/// The light from all around, and how much of all light the picture takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientLight {
    /// Radiance of the sky straight above, linear RGB.
    pub sky: Vec3,
    /// Radiance of the ground straight below, linear RGB.
    pub ground: Vec3,
    /// What radiance is multiplied by before the tonemap.
    pub exposure: f32,
}

impl AmbientLight {
    /// Chooses an exposure at which white in the full key light is a little under white in the picture, and a
    /// sky and ground that fill shadows with some of the light. The sky goes with the directional lights: lamps
    /// light it little.
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
        let around = (directional_lx + LAMPS_AROUND * local_lx).max(DARKEST_LX) * white;
        Self {
            sky: Vec3::new(0.80, 0.95, 1.20) * (around * 0.20),
            ground: Vec3::new(1.05, 0.95, 0.85) * (around * 0.08),
            exposure: 1.5 / (directional_lx.max(local_lx).max(DARKEST_LX) * white),
        }
    }

    /// Returns the colour of the empty sky in a lit pass: scene-linear, exposure applied.
    pub fn background(&self) -> [f64; 4] {
        let [red, green, blue] = (self.sky * self.exposure).as_dvec3().to_array();
        [red, green, blue, 1.0]
    }
}

/// How much of the light of lamps comes back from all around.
const LAMPS_AROUND: f32 = 0.2;
/// A scene without light counts as having this much.
const DARKEST_LX: f32 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn light(kind: LightKind, intensity: f32) -> Light {
        Light { name: None, kind, color: Vec3::ONE, intensity, casts_shadow: true }
    }

    #[test]
    fn suns_add_up_and_lamps_count_by_the_middle_one_of_what_they_light() {
        let sun = light(LightKind::Directional { direction: DVec3::NEG_Y }, 5_000.0);
        let lamp =
            |intensity| light(LightKind::Point { position_world: DVec3::ZERO, range: None }, intensity);
        let thing = |x: f64| Aabb { min: DVec3::new(x, -0.1, -0.1), max: DVec3::new(x + 0.2, 0.1, 0.1) };
        let key = KeyLight::estimate(
            &[sun.clone(), sun, lamp(40.0)],
            &[thing(0.0), thing(1.9), thing(9.9), thing(9.9), thing(900.0)],
        );
        assert_eq!(key.directional_lx, 10_000.0);
        assert!((key.local_lx - 10.0).abs() < 0.1, "{key:?}");
    }

    #[test]
    fn a_lamp_inside_a_thing_lights_it_from_no_nearer_than_its_size() {
        let lamp = light(LightKind::Point { position_world: DVec3::ZERO, range: None }, 100.0);
        let room = Aabb { min: DVec3::splat(-5.0), max: DVec3::splat(5.0) };
        assert!(KeyLight::estimate(&[lamp], &[room]).local_lx < 2.0);
    }

    #[test]
    fn a_scene_without_light_has_a_finite_exposure_all_the_same() {
        let ambient_light = AmbientLight::for_key_light(KeyLight::estimate(&[], &[]));
        assert!(
            ambient_light.exposure.is_finite()
                && ambient_light.background().iter().all(|value| value.is_finite())
        );
    }
}
