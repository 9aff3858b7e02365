//! Selection of the lights that get shadows.

use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_4;

use glam::{DMat3, DVec3, Vec3};
use shadowgraph_scene::{Aabb, BoundingSphere, Camera, ConvexVolume, Light, LightKind, Plane};

use crate::cascades::{Slice, slice_sphere};
use crate::ortho::{OrthoFit, light_from_world, upright_from_world};
use crate::settings::{DistanceMeasure, LightShadows};
use crate::spot::SpotCone;

/// A light with `casts_shadow` that has no shadows in this frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Unshadowed {
    /// Index of the light in the scene.
    pub light: u32,
    /// The reason.
    pub reason: UnshadowedReason,
}

/// Reason why a light has no shadows in a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum UnshadowedReason {
    /// More important lights use all tiles of the atlas.
    AtlasFull,
    /// More important lights use all pages of the pool of virtual shadow maps.
    PoolFull,
    /// No caster is in its range.
    NoCasterInRange,
    /// It lights nothing visible within the shadow distance.
    OutOfView,
    /// Its intensity or colour is zero.
    NoIntensity,
    /// Its direction is zero, or a number in it is not finite.
    InvalidLight,
}

impl UnshadowedReason {
    /// Describes the reason.
    #[must_use]
    pub fn describe(self) -> &'static str {
        match self {
            Self::AtlasFull => "the shadow atlas is full: more important lights use its tiles",
            Self::PoolFull => "the pool of pages is full: more important lights use them",
            Self::NoCasterInRange => "no shadow caster in range",
            Self::OutOfView => "the light does not reach the view within the shadow distance",
            Self::NoIntensity => "the intensity is zero",
            Self::InvalidLight => "the direction is zero, or a number is not finite",
        }
    }
}

/// The range of the view in which there are shadows.
pub(crate) struct ShadowRange<'a> {
    pub(crate) camera: &'a Camera,
    pub(crate) aspect: f64,
    pub(crate) near_m: f64,
    pub(crate) distance_m: f64,
    pub(crate) measure: DistanceMeasure,
    /// View depth before which there are no receivers, metres: the near plane, or more.
    pub(crate) nearest_m: f64,
    /// View depth before which no receiver is in the view, metres.
    pub(crate) visible_m: f64,
    /// Start of the first cascade, metres of view depth.
    pub(crate) begin_m: f64,
    /// End of the cascades, metres of view depth: the shadow distance, or less if there are no receivers beyond.
    pub(crate) fit_m: f64,
    /// A sphere around all receivers.
    pub(crate) receivers: BoundingSphere,
}

impl ShadowRange<'_> {
    /// Returns a sphere around the receivers between two view depths: that of the slice, or that of all receivers or of the whole shadow
    /// distance if it is smaller.
    pub(crate) fn sphere(&self, near_m: f64, far_m: f64) -> BoundingSphere {
        let slice = slice_sphere(&Slice { camera: self.camera, aspect: self.aspect, near_m, far_m });
        let sphere = if self.receivers.radius_m <= slice.radius_m { self.receivers } else { slice };
        if self.measure == DistanceMeasure::Radius && self.distance_m < sphere.radius_m {
            return BoundingSphere { center_world: self.camera.position_world(), radius_m: self.distance_m };
        }
        sphere
    }

    /// Returns the slice of view depths that a cascade covers, metres: the last one also what is in front of the first.
    pub(crate) fn covered(&self, [near_m, far_m]: [f64; 2]) -> [f64; 2] {
        let is_last = far_m == self.fit_m && self.begin_m > self.nearest_m;
        [if is_last { self.nearest_m } else { near_m }, far_m]
    }

    /// Returns whether the view has receivers in front of the first cascade.
    pub(crate) fn begins_late(&self) -> bool {
        self.begin_m > self.visible_m
    }

    /// Returns the corners of the slice between two view depths, world space.
    pub(crate) fn corners(&self, near_m: f64, far_m: f64) -> [DVec3; 8] {
        let corners = self.camera.slice_corners_view(self.aspect, near_m, far_m);
        corners.map(|corner| self.camera.world_from_view.transform_point3(corner))
    }

    /// Returns whether a box covers all receivers.
    pub(crate) fn is_whole(&self, fit: &OrthoFit) -> bool {
        fit.sphere == self.receivers
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.near_m >= self.distance_m
    }

    /// Returns whether a sphere may intersect it.
    fn touches(&self, sphere: BoundingSphere) -> bool {
        let eye = self.camera.position_world();
        if self.measure == DistanceMeasure::Radius
            && eye.distance(sphere.center_world) - sphere.radius_m > self.distance_m
        {
            return false;
        }
        let mut volume: ConvexVolume = self.camera.frustum(self.aspect);
        let forward = self.camera.forward_world();
        let end = eye + forward * self.distance_m;
        volume.planes.push(Plane::through(end, -forward));
        let half = DVec3::splat(sphere.radius_m);
        volume.intersects(&Aabb { min: sphere.center_world - half, max: sphere.center_world + half })
    }
}

/// A light that requests tiles, and their shape.
pub(crate) struct Candidate<'s> {
    pub(crate) light: u32,
    pub(crate) shape: Shape,
    /// Its individual settings.
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
    /// Returns the number of atlas tiles that it needs.
    pub(crate) fn tiles(&self) -> usize {
        if matches!(self, Self::Point { .. }) { POINT_FACES.len() } else { 1 }
    }
}

/// Returns the pyramid of a face of a point light, and the rotation from world to its axes.
pub(crate) fn point_face(position_world: DVec3, range_m: f64, face: usize) -> (SpotCone, DMat3) {
    let direction = POINT_FACES[face];
    // An axis is never zero.
    let rotation = upright_from_world(direction).unwrap_or(DMat3::IDENTITY);
    (SpotCone { position_world, direction, half_angle: FRAC_PI_4, range_m }, rotation)
}

/// The directions of the six tiles of a point light, in the order of `cube_face` in `tiles.wgsl`.
const POINT_FACES: [DVec3; 6] = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];

impl Candidate<'_> {
    /// Compares by importance: the most important first, equal ones in the scene's order.
    pub(crate) fn order(&self, other: &Self) -> Ordering {
        let (a, b) = (self.importance, other.importance);
        b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)).then(self.light.cmp(&other.light))
    }

    /// Returns the fraction of the view that its light can cover, times the user's weight; infinite for directional lights.
    pub(crate) fn coverage(&self) -> f64 {
        self.importance.0
    }
}

/// Returns the candidate for a light with `casts_shadow`, or the reason why it has no shadows in this view.
pub(crate) fn candidate<'s>(
    light: u32,
    source: &Light,
    own: Option<&'s LightShadows>,
    range: &ShadowRange<'_>,
) -> Result<Candidate<'s>, UnshadowedReason> {
    if !source.is_usable() {
        return Err(UnshadowedReason::InvalidLight);
    }
    let brightness = brightness(source);
    if brightness <= 0.0 {
        return Err(UnshadowedReason::NoIntensity);
    }
    let shape = shape(source)?;
    let weight = own.map_or(1.0, |own| f64::from(own.importance));
    let importance = match shape {
        // Directional lights cover everything: they come before all others.
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
    let invalid = UnshadowedReason::InvalidLight;
    Ok(match source.kind {
        LightKind::Directional { direction } => {
            Shape::Directional { light_from_world: light_from_world(direction).ok_or(invalid)? }
        }
        LightKind::Spot { position_world, direction, outer_angle: half_angle, .. } => {
            let light_from_world = upright_from_world(direction).ok_or(invalid)?;
            let direction = direction.normalize();
            Shape::Spot {
                cone: SpotCone { position_world, direction, half_angle, range_m },
                light_from_world,
            }
        }
        LightKind::Point { position_world, .. } => Shape::Point { position_world, range_m },
    })
}

/// Returns the fraction of the view that the light can cover, and its brightness at the camera.
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
