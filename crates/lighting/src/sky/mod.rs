//! The light of a sky that follows the sun, and of the ground below it.

mod dome;
mod harmonics;

use bytemuck::{Pod, Zeroable, bytes_of};
use glam::{DVec3, Vec3, Vec4};
use shadowgraph_core::{Buffer, Frame};
use shadowgraph_scene::{GroundPlane, Light, LightKind};

use crate::key_light::KeyLight;
use dome::Dome;

/// What is drawn where there is no geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backdrop {
    /// The sky, and the ground below it.
    #[default]
    Sky,
    /// Nothing but the shadows on the ground, as alpha over black.
    Shadows,
}

/// What the light of a sky depends on.
#[derive(Clone, Debug, PartialEq)]
pub struct SkySettings {
    /// The amount of aerosols, 1 to 10: 2 is an arctic sky, 3 a clear one, 6 a warm and moist day, 10 haze.
    pub turbidity: f32,
    /// Angular radius of the sun's disc, radians; the sun's is 0.00465.
    pub disc_rad: f32,
    /// The albedo of the ground, linear RGB, each 0 to 1.
    pub ground_albedo: Vec3,
}

impl Default for SkySettings {
    fn default() -> Self {
        Self { turbidity: 3.0, disc_rad: 0.0075, ground_albedo: GroundPlane::ALBEDO }
    }
}

/// `Sky` of `sky_light.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
struct GpuSky {
    distribution: [Vec4; 9],
    irradiance: [Vec4; 9],
    radiance: Vec3,
    cos_disc: f32,
    to_sun: Vec3,
    backdrop: u32,
    disc: Vec3,
    ground_height: f32,
    ground: Vec3,
    padding0: u32,
    ground_albedo: Vec3,
    padding1: u32,
}

/// The light of a sky: its radiance in every direction, and the irradiance of surfaces.
///
/// The sky is that of Hosek and Wilkie ("An Analytic Model for Full Spectral Sky-Dome Radiance", 2012) around the strongest
/// directional light above the horizon. Its illuminance is a share of that light's, as measured under clear skies. Without such a
/// light it is grey, as bright as the ambient light of the spot and point lights.
#[derive(Clone, Debug, PartialEq)]
pub struct SkyLight(GpuSky);

impl SkyLight {
    /// Computes the light of the sky above some lights.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shadowgraph_lighting::{KeyLight, SkyLight, SkySettings};
    /// use shadowgraph_scene::{Light, LightKind};
    /// let sun = |elevation: f64| Light {
    ///     name: None,
    ///     kind: LightKind::Directional { direction: DVec3::new(-elevation.cos(), -elevation.sin(), 0.0) },
    ///     color: glam::Vec3::ONE,
    ///     intensity: 80_000.0,
    ///     casts_shadow: true,
    /// };
    /// let sky = |elevation| {
    ///     let lights = [sun(elevation)];
    ///     SkyLight::new(&lights, KeyLight::estimate(&lights, &[]), &SkySettings::default())
    /// };
    /// let [noon, evening] = [1.2, 0.1].map(|elevation| sky(elevation).radiance(glam::Vec3::Y));
    /// assert!(noon.z > noon.x, "the sky is blue: {noon}");
    /// assert!(noon.z > evening.z, "and darker in the evening: {noon}, {evening}");
    /// ```
    #[must_use]
    pub fn new(lights: &[Light], key: KeyLight, settings: &SkySettings) -> Self {
        let dome = Dome::new(lights, key, settings);
        let direct: Vec3 = lights.iter().filter(|light| light.is_usable()).map(horizontal_illuminance).sum();
        let radiance_of_ground =
            |from_sky: Vec3| settings.ground_albedo * (direct + from_sky) / std::f32::consts::PI;
        let from_sky = harmonics::irradiance_upwards(|direction| dome.radiance(direction));
        let ground = radiance_of_ground(from_sky);
        let irradiance =
            harmonics::irradiance_over_pi(
                |direction| {
                    if direction.y < 0.0 { ground } else { dome.radiance(direction) }
                },
            );
        Self(GpuSky {
            distribution: dome.distribution.map(|value| value.extend(0.0)),
            irradiance: irradiance.map(|value| value.extend(0.0)),
            radiance: dome.scale,
            cos_disc: settings.disc_rad.cos(),
            to_sun: dome.to_sun,
            backdrop: 0,
            disc: dome.disc,
            ground_height: 0.0,
            ground,
            padding0: 0,
            ground_albedo: settings.ground_albedo,
            padding1: 0,
        })
    }

    /// Returns the radiance of the sky in a direction of unit length, without the sun's disc; below the horizon that of the ground.
    #[must_use]
    pub fn radiance(&self, direction: Vec3) -> Vec3 {
        if direction.y < 0.0 {
            return self.0.ground;
        }
        let distribution = self.0.distribution.map(Vec4::truncate);
        dome::radiance(&distribution, self.0.radiance, self.0.to_sun, direction)
    }

    /// Uploads the sky, with the ground and the kind of background to draw.
    pub fn upload(
        &self,
        frame: &mut Frame<'_>,
        ground: Option<&GroundPlane>,
        backdrop: Backdrop,
        origin_world: DVec3,
    ) -> Buffer {
        let mut sky = self.0;
        sky.backdrop = match backdrop {
            Backdrop::Sky => 0,
            Backdrop::Shadows => 1,
        };
        if let Some(ground) = ground {
            sky.ground_height = (ground.height_world - origin_world.y) as f32;
        }
        frame.upload_buffer("sky", bytes_of(&sky).to_vec())
    }
}

/// Returns the illuminance of the ground by a directional light, per colour.
fn horizontal_illuminance(light: &Light) -> Vec3 {
    match light.kind {
        LightKind::Directional { direction } => {
            light.color * light.intensity * (-direction.normalize_or_zero().y).max(0.0) as f32
        }
        _ => Vec3::ZERO,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use shadowgraph_shaders::{NONE, SKY_LIGHT, check_layout, compose};

    use super::*;

    #[test]
    fn uniforms_have_the_layout_of_the_wgsl_struct() {
        let sky = SKY_LIGHT.with_value("ENVIRONMENT", "2");
        let module = compose("background.wgsl", &[NONE, sky]).unwrap();
        check_layout!(&module, "Sky", GpuSky:
            distribution, irradiance, radiance, cos_disc, to_sun, backdrop, disc,
            ground_height, ground, ground_albedo,
        )
        .unwrap();
    }

    fn sun(elevation_deg: f64) -> Light {
        let (sin, cos) = elevation_deg.to_radians().sin_cos();
        let kind = LightKind::Directional { direction: DVec3::new(-cos, -sin, 0.0) };
        Light { name: None, kind, color: Vec3::ONE, intensity: 100_000.0, casts_shadow: true }
    }

    fn sky(lights: &[Light]) -> SkyLight {
        SkyLight::new(lights, KeyLight::estimate(lights, &[]), &SkySettings::default())
    }

    #[test]
    fn the_sky_lights_the_ground_by_the_measured_share_of_the_suns_light() {
        for (elevation_deg, share) in [(60.0, 0.152), (30.0, 0.140), (10.0, 0.191)] {
            let sky = sky(&[sun(elevation_deg)]);
            let lux = harmonics::irradiance_upwards(|direction| sky.radiance(direction));
            let luminance = lux.dot(Vec3::new(0.2126, 0.7152, 0.0722));
            let found = luminance / 100_000.0;
            assert!((found / share - 1.0).abs() < 0.03, "{elevation_deg} degrees: {found}, expected {share}");
        }
    }

    #[test]
    fn the_sky_is_brighter_towards_the_sun_and_finite_without_one() {
        let day = sky(&[sun(20.0)]);
        let towards = day.radiance(Vec3::new(0.9, 0.3, 0.0).normalize());
        let away = day.radiance(Vec3::new(-0.9, 0.3, 0.0).normalize());
        assert!(towards.x > 2.0 * away.x, "{towards} {away}");
        for lights in [vec![], vec![sun(-20.0)], vec![sun(90.0)], vec![sun(0.0)]] {
            let sky = sky(&lights);
            for direction in [Vec3::Y, Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.8, 0.0)] {
                let radiance = sky.radiance(direction);
                assert!(radiance.is_finite() && radiance.min_element() >= 0.0, "{lights:?}: {radiance}");
            }
        }
    }
}
