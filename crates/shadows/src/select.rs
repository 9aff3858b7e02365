//! Which lights get shadows.

use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_4;

use glam::{DMat3, DVec3, Vec3};
use shadowgraph_scene::{Aabb, BoundingSphere, Camera, ConvexVolume, Light, LightKind, Plane};

use crate::basis::light_from_world;
use crate::settings::LightShadows;
use crate::spot::SpotCone;

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
    /// More important lights have all the tiles of the atlas.
    AtlasFull,
    /// Nothing that casts a shadow is in its reach.
    NoCasterInRange,
    /// It lights nothing that the camera sees within the shadow distance.
    OutOfView,
    /// It gives no light.
    NoLight,
    /// Its direction has no length, or a number in it is not finite.
    Unusable,
}

impl UnshadowedReason {
    /// Says it in words.
    #[must_use]
    pub fn text(self) -> &'static str {
        match self {
            Self::AtlasFull => "the shadow atlas is full: more important lights have its tiles",
            Self::NoCasterInRange => "no shadow caster in reach",
            Self::OutOfView => "nothing in view within the shadow distance is lit",
            Self::NoLight => "no light is given",
            Self::Unusable => "a direction without length, or a number that is not usable",
        }
    }
}

/// The part of the view in which there are shadows.
pub(crate) struct ShadowRange<'a> {
    pub(crate) camera: &'a Camera,
    pub(crate) aspect: f64,
    pub(crate) near_m: f64,
    pub(crate) distance_m: f64,
    /// Where cascades end, metres of view depth: at the distance, or before, where nothing is left to be shadowed.
    pub(crate) fit_m: f64,
}

impl ShadowRange<'_> {
    pub(crate) fn is_empty(&self) -> bool {
        self.near_m >= self.distance_m
    }

    /// Whether a sphere may reach into it.
    fn touches(&self, sphere: BoundingSphere) -> bool {
        let mut volume: ConvexVolume = self.camera.frustum(self.aspect);
        let forward = self.camera.forward_world();
        let end = self.camera.position_world() + forward * self.distance_m;
        volume.planes.push(Plane::through(end, -forward));
        let half = DVec3::splat(sphere.radius_m);
        volume.intersects(&Aabb { min: sphere.center_world - half, max: sphere.center_world + half })
    }
}

/// A light that wants tiles, and what kind of tiles.
pub(crate) struct Candidate<'s> {
    pub(crate) light: u32,
    pub(crate) shape: Shape,
    /// What the user wants to be different for it.
    pub(crate) own: Option<&'s LightShadows>,
    importance: (f64, f64),
}

#[derive(Clone, Copy)]
pub(crate) enum Shape {
    Directional { light_from_world: DMat3 },
    Spot { cone: SpotCone, light_from_world: DMat3 },
    Point { position_world: DVec3, range_m: f64 },
}

impl Shape {
    /// How many tiles of the atlas it needs.
    pub(crate) fn tiles(&self) -> usize {
        if matches!(self, Self::Point { .. }) { POINT_FACES.len() } else { 1 }
    }
}

/// The pyramid of one side of a point light, and the rotation from world to it.
pub(crate) fn point_face(position_world: DVec3, range_m: f64, face: usize) -> (SpotCone, DMat3) {
    let direction = POINT_FACES[face];
    // An axis has a length.
    let rotation = light_from_world(direction).unwrap_or(DMat3::IDENTITY);
    (SpotCone { position_world, direction, half_angle: FRAC_PI_4, range_m }, rotation)
}

/// Which way the six tiles of a point light look, in their order: `cube_face` of `tiles.wgsl`.
const POINT_FACES: [DVec3; 6] = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];

impl Candidate<'_> {
    /// Most important first; equally important ones in the scene's order.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let (a, b) = (self.importance, other.importance);
        b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)).then(self.light.cmp(&other.light))
    }

    /// How much of the view its light can fill, times what the user weighs it with; infinite for directional lights.
    pub(crate) fn coverage(&self) -> f64 {
        self.importance.0
    }
}

/// Finds whether a light that casts shadows can have some in this view.
pub(crate) fn candidate<'s>(
    light: u32,
    source: &Light,
    own: Option<&'s LightShadows>,
    range: &ShadowRange<'_>,
) -> Result<Candidate<'s>, UnshadowedReason> {
    if !source.is_usable() {
        return Err(UnshadowedReason::Unusable);
    }
    let brightness = brightness(source);
    if brightness <= 0.0 {
        return Err(UnshadowedReason::NoLight);
    }
    let shape = shape(source)?;
    let weight = own.map_or(1.0, |own| f64::from(own.importance));
    let importance = match shape {
        // Directional lights are everywhere: before any other light.
        Shape::Directional { .. } => (f64::INFINITY, weight * brightness),
        Shape::Spot { cone, .. } => local_importance(cone.bounding_sphere(), weight, brightness, range)?,
        Shape::Point { position_world, range_m } => {
            let sphere = BoundingSphere { center_world: position_world, radius_m: range_m };
            local_importance(sphere, weight, brightness, range)?
        }
    };
    Ok(Candidate { light, shape, own, importance })
}

fn shape(source: &Light) -> Result<Shape, UnshadowedReason> {
    let range_m = source.effective_range().unwrap_or(f64::INFINITY);
    let rotation = |direction| light_from_world(direction).ok_or(UnshadowedReason::Unusable);
    Ok(match source.kind {
        LightKind::Directional { direction } => Shape::Directional { light_from_world: rotation(direction)? },
        LightKind::Spot { position_world, direction, outer_angle: half_angle, .. } => {
            let light_from_world = rotation(direction)?;
            let direction = direction.normalize();
            Shape::Spot {
                cone: SpotCone { position_world, direction, half_angle, range_m },
                light_from_world,
            }
        }
        LightKind::Point { position_world, .. } => Shape::Point { position_world, range_m },
    })
}

/// How much of the view its light can fill, then how bright it is from the camera.
fn local_importance(
    sphere: BoundingSphere,
    weight: f64,
    brightness: f64,
    range: &ShadowRange<'_>,
) -> Result<(f64, f64), UnshadowedReason> {
    if !range.touches(sphere) {
        return Err(UnshadowedReason::OutOfView);
    }
    let distance_m = range.camera.position_world().distance(sphere.center_world);
    let coverage = sphere.radius_m / distance_m.max(sphere.radius_m);
    Ok((weight * coverage, brightness / (distance_m * distance_m).max(1e-6)))
}

fn brightness(light: &Light) -> f64 {
    f64::from(light.color.dot(Vec3::new(0.2126, 0.7152, 0.0722))) * f64::from(light.intensity)
}
