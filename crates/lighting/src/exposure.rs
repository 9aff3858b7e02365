//! How bright a scene is, and what light there is that no light source is counted for.

use glam::Vec3;
use shadowgraph_scene::{Aabb, Light, LightKind};

/// How much light a scene's light sources give where they matter, lux.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// The directional lights together.
    pub directional_lx: f32,
    /// The brightest spot or point light, at the distance of a tenth of the scene from it.
    pub local_lx: f32,
}

impl Key {
    /// Estimates the key light of a scene within `bounds`.
    pub fn of(lights: &[Light], bounds: &Aabb) -> Self {
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
        Self { directional_lx: directional as f32, local_lx: local as f32 }
    }
}

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
    /// sky and ground that fill shadows with some of the light. The sky goes with the directional lights: lamps
    /// light it little.
    ///
    /// ```
    /// use shadowgraph_lighting::{Ambience, Key};
    /// let day = Ambience::for_key(Key { directional_lx: 100_000.0, local_lx: 50.0 });
    /// let night = Ambience::for_key(Key { directional_lx: 0.3, local_lx: 50.0 });
    /// assert!(day.exposure < night.exposure && day.sky.x > night.sky.x);
    /// ```
    pub fn for_key(key: Key) -> Self {
        let Key { directional_lx, local_lx } = key;
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
const LAMPS_AROUND: f32 = 0.1;
/// A scene without light counts as having this much.
const DARKEST_LX: f32 = 1e-6;

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
    fn suns_add_up_and_the_brightest_lamp_counts() {
        let sun = light(LightKind::Directional { direction: DVec3::NEG_Y }, 5_000.0);
        let lamp =
            |intensity| light(LightKind::Point { position_world: DVec3::ZERO, range: None }, intensity);
        let bounds = Aabb { min: DVec3::ZERO, max: DVec3::new(10.0, 0.0, 0.0) };
        let key = Key::of(&[sun.clone(), sun, lamp(10.0), lamp(40.0)], &bounds);
        assert_eq!(key, Key { directional_lx: 10_000.0, local_lx: 40.0 });
    }

    #[test]
    fn a_scene_without_light_has_a_finite_exposure_all_the_same() {
        let ambience = Ambience::for_key(Key::of(&[], &Aabb::EMPTY));
        assert!(ambience.exposure.is_finite() && ambience.background().iter().all(|value| value.is_finite()));
    }
}
