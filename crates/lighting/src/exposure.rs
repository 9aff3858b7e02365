//! The brightness of a scene: its ambient light and its exposure.

use glam::Vec3;

use crate::key_light::{KeyLight, MIN_LX};

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_without_light_has_a_finite_exposure() {
        let ambient_light = AmbientLight::for_key_light(KeyLight::estimate(&[], &[]));
        assert!(
            ambient_light.exposure.is_finite()
                && ambient_light.background().iter().all(|value| value.is_finite())
        );
    }
}
