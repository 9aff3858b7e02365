//! Conversion of the lights of KHR_lights_punctual.

use std::f64::consts::FRAC_PI_2;

use ::gltf::json;
use glam::{DAffine3, DVec3, Vec3};
use json::extensions::scene::khr_lights_punctual::{Light as JsonLight, Type};
use json::validation::Checked;

use super::notes::Notes;
use crate::light::{Light, LightKind};

/// A light of the file, before a node positions it.
#[derive(Clone, Debug)]
pub(super) struct PunctualLight {
    kind: PunctualLightKind,
    color: Vec3,
    intensity: f32,
}

#[derive(Clone, Copy, Debug)]
enum PunctualLightKind {
    Directional,
    Point { range: Option<f64> },
    Spot { range: Option<f64>, inner_angle: f64, outer_angle: f64 },
}

/// Converts a light.
///
/// # Errors
/// The message says which value is out of range and what is allowed.
pub(super) fn convert(light: &JsonLight, location: &str, notes: &mut Notes) -> Result<PunctualLight, String> {
    let color = Vec3::from(light.color);
    if !(color.is_finite() && color.cmpge(Vec3::ZERO).all()) {
        return Err(format!("color is {color} (allowed: 0 or more)"));
    }
    if !(light.intensity.is_finite() && light.intensity >= 0.0) {
        return Err(format!("intensity is {} (allowed: 0 or more)", light.intensity));
    }
    // Some programs write 0 for "unlimited", which the extension does not allow.
    let range = light.range.map(f64::from).filter(|range| *range != 0.0);
    if let Some(range) = range.filter(|range| !(range.is_finite() && *range > 0.0)) {
        return Err(format!("range is {range} (allowed: above 0)"));
    }
    let kind = match (light.type_, &light.spot) {
        (Checked::Valid(Type::Directional), _) => PunctualLightKind::Directional,
        (Checked::Valid(Type::Point), _) => PunctualLightKind::Point { range },
        (Checked::Valid(Type::Spot), Some(cone)) => {
            let (inner, outer) = (f64::from(cone.inner_cone_angle), f64::from(cone.outer_cone_angle));
            // The f32 nearest to π/2 is a little above it.
            if !(outer > 0.0 && outer <= FRAC_PI_2 + 1e-6) {
                return Err(format!("outerConeAngle is {outer} (allowed: above 0 up to pi/2, radians)"));
            }
            if !(inner >= 0.0 && inner.is_finite()) {
                return Err(format!("innerConeAngle is {inner} (allowed: 0 to outerConeAngle, {outer})"));
            }
            if inner > outer {
                notes.add(location, "innerConeAngle is larger than outerConeAngle, which is used for both");
            }
            PunctualLightKind::Spot {
                range,
                inner_angle: inner.min(outer).min(FRAC_PI_2),
                outer_angle: outer.min(FRAC_PI_2),
            }
        }
        (Checked::Valid(Type::Spot), None) => return Err("is a spot light without `spot`".into()),
        (Checked::Invalid, _) => return Err("has an unknown type (allowed: directional, point, spot)".into()),
    };
    Ok(PunctualLight { kind, color, intensity: light.intensity })
}

/// Creates the light of a node; it shines along the node's -Z.
///
/// # Errors
/// The node's scale is 0, so that the light has no direction.
pub(super) fn light_at_node(
    light: &PunctualLight,
    name: Option<String>,
    world: &DAffine3,
) -> Result<Light, String> {
    let position_world = world.translation;
    let direction = || -> Result<DVec3, String> {
        let direction = (-world.matrix3.z_axis).try_normalize();
        direction.ok_or_else(|| "its light has no direction: the scale must not be 0".into())
    };
    let kind = match light.kind {
        PunctualLightKind::Directional => LightKind::Directional { direction: direction()? },
        PunctualLightKind::Point { range } => LightKind::Point { position_world, range },
        PunctualLightKind::Spot { range, inner_angle, outer_angle } => {
            LightKind::Spot { position_world, direction: direction()?, range, inner_angle, outer_angle }
        }
    };
    Ok(Light { name, kind, color: light.color, intensity: light.intensity, casts_shadow: true })
}
