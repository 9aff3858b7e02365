//! Ray-traced ground truth of the visibility of a light at the surfaces of a view.

use glam::{DVec3, Vec3};
use shadowgraph_scene::{Light, LightKind};
use shadowgraph_shadows::rays::{LightShape, RayScene, ReceiverPoint, trace_hard, trace_soft};

use super::Surfaces;
use super::parallel::map_pixels;

/// Ground truth of one light in a view, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct GroundTruth {
    /// Visibility of the light's centre: 1 lit, 0 in shadow; behind translucent surfaces the mean of the transmitted
    /// colour channels; 0 where there is no geometry.
    pub hard: Vec<f32>,
    /// Distances to the nearest blocker, metres; infinite if there is none.
    pub blocker_distances_m: Vec<f32>,
    /// Cosine between the geometric normal and the direction to the light; 0 where there is no geometry, and outside
    /// a spot light's cone or a light's range.
    pub n_dot_l: Vec<f32>,
    /// Unit directions to the light; up where there is no geometry.
    pub towards_light: Vec<Vec3>,
}

/// Number of rays that determine whether a pixel can be in a penumbra.
pub const PROBE_RAYS: u32 = 8;

/// The light of a view, for rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayLight {
    /// Shape of the light.
    pub shape: LightShape,
    /// Axis of a spot light's cone and the cosine of its half angle.
    cone: Option<(Vec3, f32)>,
    range_m: f32,
}

impl RayLight {
    /// Creates the light relative to `origin_world`. `size` is its radius: in radians for a directional light (its
    /// angular radius), else in metres.
    #[must_use]
    pub fn new(light: &Light, size: f32, origin_world: DVec3) -> Self {
        let point = |position_world: DVec3| LightShape::Point {
            position: (position_world - origin_world).as_vec3(),
            radius_m: size,
        };
        let range_m = light.effective_range().map_or(f32::INFINITY, |range| range as f32);
        match light.kind {
            LightKind::Directional { direction } => {
                let to_light = (-direction).normalize_or(DVec3::Y).as_vec3();
                let shape = LightShape::Directional { to_light, angular_radius: size };
                Self { shape, cone: None, range_m: f32::INFINITY }
            }
            LightKind::Spot { position_world, direction, outer_angle, .. } => {
                let cone = Some((direction.as_vec3(), outer_angle.cos() as f32));
                Self { shape: point(position_world), cone, range_m }
            }
            LightKind::Point { position_world, .. } => {
                Self { shape: point(position_world), cone: None, range_m }
            }
        }
    }

    /// Returns the unit direction to the light from a position; `None` if the light does not reach it.
    pub(super) fn direction_from(&self, position: Vec3) -> Option<Vec3> {
        let center = match self.shape {
            LightShape::Directional { to_light, .. } => return Some(to_light),
            LightShape::Point { position, .. } => position,
        };
        let (to_light, distance_m) = (center - position).normalize_and_length();
        let in_cone = self.cone.is_none_or(|(axis, cosine)| -to_light.dot(axis) > cosine);
        (in_cone && distance_m > 0.0 && distance_m < self.range_m).then_some(to_light)
    }
}

/// Returns the mean of the colour channels, as in `probe.wgsl`.
pub(super) fn mean(visibility: Vec3) -> f32 {
    visibility.element_sum() / 3.0
}

pub(super) fn receiver(surfaces: &Surfaces, pixel: usize, eye: Vec3) -> ReceiverPoint {
    let position = surfaces.positions[pixel];
    ReceiverPoint {
        position,
        geometric_normal: surfaces.normals[pixel],
        view_distance_m: position.distance(eye),
    }
}

impl GroundTruth {
    /// Traces a ray from each pixel to the light. `eye` is the camera, relative to the frame's origin.
    #[must_use]
    pub fn trace(scene: &RayScene, surfaces: &Surfaces, light: &RayLight, eye: Vec3) -> Self {
        let dark = (0.0, f32::INFINITY, 0.0, Vec3::Y);
        let pixels = map_pixels(surfaces.size_px, |pixel| {
            let to_light =
                light.direction_from(surfaces.positions[pixel]).filter(|_| surfaces.is_drawn(pixel));
            let Some(to_light) = to_light else { return dark };
            let n_dot_l = surfaces.normals[pixel].dot(to_light);
            let truth = trace_hard(scene, &light.shape, &receiver(surfaces, pixel, eye), true);
            (mean(truth.visibility), truth.blocker_m.unwrap_or(f32::INFINITY), n_dot_l, to_light)
        });
        Self {
            hard: pixels.iter().map(|pixel| pixel.0).collect(),
            blocker_distances_m: pixels.iter().map(|pixel| pixel.1).collect(),
            n_dot_l: pixels.iter().map(|pixel| pixel.2).collect(),
            towards_light: pixels.iter().map(|pixel| pixel.3).collect(),
        }
    }

    /// Returns the fraction of the light that is visible from each pixel, by `rays` rays over its disc. Where
    /// [`PROBE_RAYS`] rays all agree with the hard reference, no more are traced.
    #[must_use]
    pub fn trace_soft(
        scene: &RayScene,
        surfaces: &Surfaces,
        light: &RayLight,
        eye: Vec3,
        hard: &[f32],
        rays: u32,
    ) -> Vec<f32> {
        map_pixels(surfaces.size_px, |pixel| {
            let reached =
                surfaces.is_drawn(pixel) && light.direction_from(surfaces.positions[pixel]).is_some();
            if !reached {
                return 0.0;
            }
            let receiver = receiver(surfaces, pixel, eye);
            let visible_fraction = |rays| mean(trace_soft(scene, &light.shape, &receiver, rays));
            let probed = visible_fraction(PROBE_RAYS);
            if probed == hard[pixel] { probed } else { visible_fraction(rays) }
        })
    }
}
