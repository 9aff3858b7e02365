//! The distribution of radiance over the sky.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};

use glam::Vec3;
use hw_skymodel::rgb::{SkyParams, SkyState};
use shadowgraph_scene::{Light, LightKind};

use super::SkySettings;
use super::harmonics::irradiance_upwards;
use crate::key_light::KeyLight;

/// The least elevation of the sun for the sky's brightness, radians. A low sun of a scene is as bright as a high one, but a low
/// sun outdoors is much darker than its sky.
const LEAST_ELEVATION: f32 = 0.14;

/// The brightness of the sun's disc relative to white in the sun.
const DISC: f32 = 16.0;

const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The radiance of the sky in all directions above the horizon.
pub(super) struct Dome {
    /// The coefficients A to I of the model, red, green and blue.
    pub(super) distribution: [Vec3; 9],
    /// The factor of the distribution.
    pub(super) scale: Vec3,
    /// The direction to the sun, unit length.
    pub(super) to_sun: Vec3,
    /// Radiance of the sun's disc.
    pub(super) disc: Vec3,
}

impl Dome {
    pub(super) fn new(lights: &[Light], key: KeyLight, settings: &SkySettings) -> Self {
        let mut suns: Vec<_> = lights.iter().filter(|light| light.is_usable()).filter_map(sun_of).collect();
        suns.sort_by(|a, b| a.1.element_sum().total_cmp(&b.1.element_sum()));
        suns.pop().map_or_else(|| Self::overcast(key), |(to_sun, light)| Self::clear(to_sun, light, settings))
    }

    /// The sky around a sun of this illuminance.
    fn clear(to_sun: Vec3, illuminance: Vec3, settings: &SkySettings) -> Self {
        let elevation = to_sun.y.clamp(0.0, 1.0).asin().min(FRAC_PI_2);
        let albedo = settings.ground_albedo.clamp(Vec3::ZERO, Vec3::ONE).to_array();
        let turbidity = settings.turbidity.clamp(1.0, 10.0);
        // The parameters are within the ranges.
        let Ok(state) = SkyState::new(&SkyParams { elevation, turbidity, albedo }) else {
            return Self::uniform(Vec3::ZERO);
        };
        let (parameters, factors) = state.raw();
        let distribution =
            std::array::from_fn(|i| Vec3::new(parameters[i], parameters[9 + i], parameters[18 + i]));
        let factors = Vec3::from(factors);
        let unscaled = irradiance_upwards(|direction| radiance(&distribution, factors, to_sun, direction));
        let share = share_of_sky(elevation) / unscaled.dot(LUMINANCE).max(1e-9);
        Self {
            distribution,
            scale: factors * illuminance * share,
            to_sun,
            disc: illuminance * (DISC * FRAC_1_PI),
        }
    }

    /// A sky without a sun: as bright as the ambient light of the spot and point lights, and at the zenith three times as bright
    /// as at the horizon (CIE standard overcast sky; Moon and Spencer, "Illumination from a Non-Uniform Sky", 1942).
    fn overcast(key: KeyLight) -> Self {
        let dome = Self::uniform(Vec3::new(0.8, 0.95, 1.2) * (key.ambient_lx() * 0.2 * FRAC_1_PI));
        let mut distribution = dome.distribution;
        (distribution[2], distribution[7]) = (Vec3::splat(0.43), Vec3::splat(0.86));
        Self { distribution, ..dome }
    }

    fn uniform(radiance: Vec3) -> Self {
        let mut distribution = [Vec3::ZERO; 9];
        distribution[2] = Vec3::ONE;
        Self { distribution, scale: radiance, to_sun: Vec3::Y, disc: Vec3::ZERO }
    }

    /// Returns the radiance in a direction of unit length that is not below the horizon.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        radiance(&self.distribution, self.scale, self.to_sun, direction)
    }
}

/// Returns the direction to a sun above the horizon, and its illuminance per colour.
fn sun_of(light: &Light) -> Option<(Vec3, Vec3)> {
    let LightKind::Directional { direction } = light.kind else { return None };
    let to_sun = -direction.normalize_or_zero().as_vec3();
    let illuminance = light.color * light.intensity;
    (to_sun.y > 0.0 && illuminance.max_element() > 0.0).then_some((to_sun, illuminance))
}

/// Returns the illuminance of the ground by a clear sky over that of a surface that faces the sun (Gillette and Pierpont,
/// "A General Illuminance Model for Daylight Availability", 1982).
fn share_of_sky(elevation: f32) -> f32 {
    let sin = elevation.max(LEAST_ELEVATION).sin();
    let sky_klx = 0.8 + 15.5 * sin.sqrt();
    let sun_klx = 127.5 * (-0.21 / sin).exp();
    sky_klx / sun_klx
}

/// The formula of Hosek and Wilkie, as in `sky_light.wgsl`.
pub(super) fn radiance(distribution: &[Vec3; 9], scale: Vec3, to_sun: Vec3, direction: Vec3) -> Vec3 {
    let [a, b, c, d, e, f, g, h, i] = *distribution;
    let cos_theta = direction.y.max(0.0);
    let cos_gamma = direction.dot(to_sun).clamp(-1.0, 1.0);
    let ray = cos_gamma * cos_gamma;
    let lobe = (Vec3::ONE + i * i - 2.0 * i * cos_gamma).max(Vec3::splat(1e-4));
    let mie = (1.0 + ray) / lobe.powf(1.5);
    let by_height = Vec3::ONE + a * (b / (cos_theta + 0.01)).exp();
    let by_angle = c + d * (e * cos_gamma.acos()).exp() + f * ray + g * mie + h * cos_theta.sqrt();
    (by_height * by_angle * scale).max(Vec3::ZERO)
}
