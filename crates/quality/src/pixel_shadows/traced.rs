//! What rays say about a pixel's surface.

use glam::{DVec2, DVec3, Vec2, Vec3};
use shadowgraph::inspect::lights::kind;
use shadowgraph::{ShadowPoint, ViewOptions};
use shadowgraph_scene::Light;
use shadowgraph_shadows::rays::{LightShape, Ray, RayScene, ReceiverPoint, trace_hard};

use super::{PixelBlocker, PixelLight, PixelSurface, Reachability};
use crate::Surfaces;
use crate::ground_truth::{RayLight, receiver};
use crate::scene_truth::SceneTruth;
use crate::subpixel::{PixelPlanes, SubpixelReference};

/// Distances that are the same up to this factor are those of one surface.
const SAME_SURFACE: f32 = 1e-3;

/// What rays from a pixel's surface depend on.
pub(super) struct Traced<'t> {
    pub(super) truth: &'t SceneTruth,
    pub(super) surfaces: &'t Surfaces,
    pub(super) options: &'t ViewOptions,
    pub(super) origin_world: DVec3,
    pub(super) index: usize,
}

impl Traced<'_> {
    fn eye(&self) -> Vec3 {
        (self.options.camera.position_world() - self.origin_world).as_vec3()
    }

    pub(super) fn surface(&self) -> PixelSurface {
        let position = self.surfaces.positions[self.index];
        PixelSurface {
            position_world: (position.as_dvec3() + self.origin_world).to_array(),
            normal: self.surfaces.normals[self.index].to_array(),
            view_depth_m: self.surfaces.view_depths_m[self.index],
            instance: self.seen(position),
        }
    }

    /// Returns the name of the instance that the camera sees.
    fn seen(&self, position: Vec3) -> Option<String> {
        let (direction, distance_m) = (position - self.eye()).normalize_and_length();
        // In front of it may be faces that the camera sees from behind, which are not drawn.
        let ray = Ray::new(self.eye(), direction, (1.0 - SAME_SURFACE) * distance_m, f32::INFINITY);
        let hit = self.truth.rays()?.nearest_hit(&ray)?;
        let is_seen = (hit.distance_m - distance_m).abs() <= SAME_SURFACE * distance_m;
        if is_seen { self.truth.name(hit.instance) } else { None }
    }

    pub(super) fn light(&self, number: u32, light: &Light) -> PixelLight {
        let source = RayLight::new(light, 0.0, self.origin_world);
        let mut found = PixelLight {
            light: number,
            name: light.name.clone().unwrap_or_default(),
            kind: kind(light),
            reach: Reachability::Outside,
            unshadowed: None,
            visibility: None,
            ray: None,
            visibility_at_point: None,
            facts: Vec::new(),
            blocker: None,
            is_at_edge: false,
            remedy: None,
        };
        let receiver = receiver(self.surfaces, self.index, self.eye());
        let Some(rays) = self.truth.rays() else { return found };
        if source.direction_from(receiver.position).is_none() {
            return found;
        }
        let hard = trace_hard(rays, &source.shape, &receiver, true);
        if hard.faces_away {
            return PixelLight { reach: Reachability::FacesAway, ..found };
        }
        found.reach = Reachability::Reached;
        found.ray = Some(hard.visibility.to_array());
        found.blocker = self.blocker(rays, &source.shape, &receiver);
        found
    }

    pub(super) fn is_at_edge(&self, light: &Light) -> bool {
        let source = RayLight::new(light, 0.0, self.origin_world);
        let Some(rays) = self.truth.rays() else { return false };
        SubpixelReference::new(rays, &source, self.surfaces, self.options).changes_around(self.index)
    }

    /// Returns the surface as techniques see it.
    pub(super) fn point(&self, light: u32) -> ShadowPoint {
        let Self { surfaces, options, origin_world, index, .. } = *self;
        let position = surfaces.positions[index];
        let planes = PixelPlanes::new(surfaces, options, origin_world);
        let to_next_pixels = [DVec2::X, DVec2::Y].map(|offset_px| {
            let next = planes.point(index, offset_px);
            next.map_or(Vec3::ZERO, |next| (next - position.as_dvec3()).as_vec3())
        });
        let width = options.size_px[0];
        ShadowPoint {
            light,
            position,
            normal: surfaces.normals[index],
            view_depth_m: surfaces.view_depths_m[index],
            to_next_pixels,
            pixel: [index as u32 % width, index as u32 / width],
        }
    }

    fn blocker(&self, rays: &RayScene, light: &LightShape, receiver: &ReceiverPoint) -> Option<PixelBlocker> {
        let hit = rays.nearest_hit(&light.ray(rays, receiver, Vec2::ZERO)?)?;
        Some(PixelBlocker { instance: self.truth.name(hit.instance)?, distance_m: hit.distance_m })
    }
}
