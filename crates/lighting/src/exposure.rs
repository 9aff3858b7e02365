//! How bright a scene is, and what light there is that no light source is counted for.

use glam::Vec3;
use shadowgraph_scene::{Aabb, Light, LightKind};

/// The light from all around, and how much of all light the picture takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ambience {
    /// Radiance of the sky straight above, linear RGB.
    pub sky: Vec3,
    /// Radiance of the ground straight below, linear RGB.
    pub ground: Vec3,
    /// What radiance is multiplied by before the tonemap.
    pub exposure: f32,
}

impl Ambience {
    /// Chooses an exposure at which white in the full key light is a little under white in the picture, and a
    /// sky and ground that fill shadows with some of the key light.
    ///
    /// ```
    /// use shadowgraph_lighting::Ambience;
    /// let (day, night) = (Ambience::for_key(100_000.0), Ambience::for_key(0.3));
    /// assert!(day.exposure < night.exposure);
    /// ```
    pub fn for_key(illuminance_lx: f32) -> Self {
        // White in the key light: illuminance / pi.
        let white = illuminance_lx.max(1e-6) / std::f32::consts::PI;
        Self {
            sky: Vec3::new(0.80, 0.95, 1.20) * (white * 0.20),
            ground: Vec3::new(1.05, 0.95, 0.85) * (white * 0.08),
            exposure: 1.5 / white,
        }
    }

    /// Returns the colour of the empty sky in a lit pass: scene-linear, exposure applied.
    pub fn background(&self) -> [f64; 4] {
        let [red, green, blue] = (self.sky * self.exposure).as_dvec3().to_array();
        [red, green, blue, 1.0]
    }
}

/// Returns the illuminance, lux, that the scene's lights give where they matter: the directional lights together,
/// or the brightest spot or point light at the distance of a tenth of the scene from it, whichever is more. 1 without
/// any light.
pub fn key_illuminance(lights: &[Light], bounds: &Aabb) -> f32 {
    let size = if bounds.is_empty() { 1.0 } else { (bounds.max - bounds.min).length() };
    let (mut directional, mut local) = (0.0, 0.0_f64);
    for light in lights {
        let intensity = f64::from(light.intensity) * f64::from(light.color.max_element());
        match light.kind {
            LightKind::Directional { .. } => directional += intensity,
            LightKind::Spot { .. } | LightKind::Point { .. } => {
                let distance = typical_distance(light.effective_range(), size);
                local = local.max(intensity / (distance * distance));
            }
        }
    }
    let key = directional.max(local);
    if key > 0.0 { key as f32 } else { 1.0 }
}

/// How far from a light the things are that it is there for.
fn typical_distance(range: Option<f64>, scene_size: f64) -> f64 {
    (scene_size * 0.1).min(range.unwrap_or(f64::INFINITY) * 0.3).max(0.05)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn light(kind: LightKind, intensity: f32) -> Light {
        Light { name: None, kind, color: Vec3::ONE, intensity, casts_shadow: true }
    }

    #[test]
    fn the_key_is_the_sun_where_there_is_one() {
        let sun = light(LightKind::Directional { direction: DVec3::NEG_Y }, 5_000.0);
        let lamp = light(LightKind::Point { position_world: DVec3::ZERO, range: None }, 10.0);
        let bounds = Aabb { min: DVec3::splat(-10.0), max: DVec3::splat(10.0) };
        assert_eq!(key_illuminance(&[sun, lamp], &bounds), 5_000.0);
    }

    #[test]
    fn a_scene_without_light_has_a_key_all_the_same() {
        assert_eq!(key_illuminance(&[], &Aabb::EMPTY), 1.0);
    }
}
