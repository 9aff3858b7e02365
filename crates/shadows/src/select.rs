//! Which lights get shadows.

use std::cmp::Ordering;

use glam::{DMat3, DVec3, Vec3};
use shadowgraph_scene::{Aabb, Camera, ConvexVolume, Light, LightKind, Plane};

use crate::{Sphere, SpotCone, light_from_world};

/// A light that is to cast shadows but has none in this frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unshadowed {
    /// Its place in the scene's list.
    pub light: u32,
    /// Why it has none.
    pub reason: UnshadowedReason,
}

/// Why a light has no shadows in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UnshadowedReason {
    /// The atlas has 16 tiles, and as many lights are more important.
    AtlasFull,
    /// Nothing that casts a shadow is in its reach.
    NoCasterInReach,
    /// It lights nothing that the camera sees within the shadow distance.
    OutOfReach,
    /// It gives no light.
    NoLight,
    /// Its direction has no length, or a number in it is not finite.
    Unusable,
    /// Point lights cast no shadows yet.
    PointLight,
}

impl UnshadowedReason {
    /// Says it in words.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::AtlasFull => "the shadow atlas is full (16 tiles) and more important lights have them",
            Self::NoCasterInReach => "no shadow caster in reach",
            Self::OutOfReach => "nothing in view within the shadow distance is lit",
            Self::NoLight => "no light is given",
            Self::Unusable => "a direction without length, or a number that is not usable",
            Self::PointLight => "point lights cast no shadows yet",
        }
    }
}

/// The part of the view in which there are shadows.
pub(crate) struct Reach<'a> {
    pub(crate) camera: &'a Camera,
    pub(crate) aspect: f64,
    pub(crate) near_m: f64,
    pub(crate) distance_m: f64,
    /// Where cascades end, metres of view depth: at the distance, or before, where nothing is left to be shadowed.
    pub(crate) fit_m: f64,
}

impl Reach<'_> {
    pub(crate) fn is_empty(&self) -> bool {
        self.near_m >= self.distance_m
    }

    /// Whether a sphere may reach into it.
    fn touches(&self, sphere: Sphere) -> bool {
        let mut volume: ConvexVolume = self.camera.volume(self.aspect);
        let forward = self.camera.forward_world();
        let end = self.camera.position_world() + forward * self.distance_m;
        volume.planes.push(Plane::through(end, -forward));
        let half = DVec3::splat(sphere.radius_m);
        volume.intersects(&Aabb { min: sphere.center_world - half, max: sphere.center_world + half })
    }
}

/// A light that wants a tile, and what kind of tile.
pub(crate) struct Candidate {
    pub(crate) light: u32,
    pub(crate) shape: Shape,
    importance: (f64, f64),
}

#[derive(Clone, Copy)]
pub(crate) enum Shape {
    Directional { light_from_world: DMat3 },
    Spot { cone: SpotCone, light_from_world: DMat3 },
}

impl Candidate {
    /// Most important first; equally important ones in the scene's order.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let (a, b) = (self.importance, other.importance);
        b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)).then(self.light.cmp(&other.light))
    }
}

/// Finds whether a light that casts shadows can have some in this view.
pub(crate) fn candidate(
    light: u32,
    source: &Light,
    reach: &Reach<'_>,
) -> Result<Candidate, UnshadowedReason> {
    let brightness = brightness(source);
    if !brightness.is_finite() {
        return Err(UnshadowedReason::Unusable);
    }
    if brightness <= 0.0 {
        return Err(UnshadowedReason::NoLight);
    }
    match source.kind {
        LightKind::Point { .. } => Err(UnshadowedReason::PointLight),
        LightKind::Directional { direction } => {
            let light_from_world = light_from_world(direction).ok_or(UnshadowedReason::Unusable)?;
            // Directional lights are everywhere: before any spot light.
            let importance = (f64::INFINITY, brightness);
            Ok(Candidate { light, shape: Shape::Directional { light_from_world }, importance })
        }
        LightKind::Spot { position_world, direction, outer_angle, .. } => {
            let light_from_world = light_from_world(direction).ok_or(UnshadowedReason::Unusable)?;
            let range_m = source.effective_range().unwrap_or(0.0);
            let usable = position_world.is_finite() && range_m.is_finite() && outer_angle.is_finite();
            if !usable || range_m <= 0.0 || outer_angle <= 0.0 {
                return Err(UnshadowedReason::Unusable);
            }
            let direction = direction.normalize();
            let cone = SpotCone { position_world, direction, half_angle: outer_angle, range_m };
            let importance = spot_importance(&cone, brightness, reach)?;
            Ok(Candidate { light, shape: Shape::Spot { cone, light_from_world }, importance })
        }
    }
}

/// How much of the view its light can fill, then how bright it is from the camera.
fn spot_importance(
    cone: &SpotCone,
    brightness: f64,
    reach: &Reach<'_>,
) -> Result<(f64, f64), UnshadowedReason> {
    let sphere = cone.bounding_sphere();
    if !reach.touches(sphere) {
        return Err(UnshadowedReason::OutOfReach);
    }
    let distance_m = reach.camera.position_world().distance(sphere.center_world);
    let coverage = sphere.radius_m / distance_m.max(sphere.radius_m);
    Ok((coverage, brightness / (distance_m * distance_m).max(1e-6)))
}

/// Returns the place in the list of the main light: the brightest directional one.
pub(crate) fn main_light(candidates: &[Candidate]) -> Option<usize> {
    let directional =
        candidates.iter().enumerate().filter(|(_, c)| matches!(c.shape, Shape::Directional { .. }));
    directional.min_by(|a, b| a.1.order(b.1)).map(|(i, _)| i)
}

fn brightness(light: &Light) -> f64 {
    f64::from(light.color.dot(Vec3::new(0.2126, 0.7152, 0.0722))) * f64::from(light.intensity)
}
