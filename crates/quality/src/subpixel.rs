//! Ground truth between the centres of pixels.

use glam::{DMat4, DVec2, DVec3, Vec3};
use shadowgraph_shadows::rays::{RayScene, ReceiverPoint, trace_hard};

use super::Surfaces;
use super::ground_truth::{RayLight, mean};
use shadowgraph::ViewOptions;

/// Half the side of the grid around the centre of a pixel, pixels.
pub const SUBPIXEL_RADIUS_PX: f64 = 1.0;

/// Number of points in each row and column of the grid.
pub const SUBPIXEL_GRID: u32 = 7;

/// Traces points between the centres of pixels, because shadows can be narrower than the distance of pixels.
pub(super) struct SubpixelReference<'a> {
    rays: &'a RayScene,
    light: &'a RayLight,
    planes: PixelPlanes<'a>,
    eye: Vec3,
}

impl<'a> SubpixelReference<'a> {
    pub(super) fn new(
        rays: &'a RayScene,
        light: &'a RayLight,
        surfaces: &'a Surfaces,
        options: &ViewOptions,
    ) -> Self {
        let origin_world = rays.origin_world();
        let eye = (options.camera.position_world() - origin_world).as_vec3();
        Self { rays, light, planes: PixelPlanes::new(surfaces, options, origin_world), eye }
    }

    /// Returns whether the reference changes within [`SUBPIXEL_RADIUS_PX`] of a pixel's centre, on its tangent plane.
    pub(super) fn changes_around(&self, pixel: usize) -> bool {
        let steps =
            || (0..SUBPIXEL_GRID).map(|step| f64::from(step) / f64::from(SUBPIXEL_GRID - 1) * 2.0 - 1.0);
        let offsets = steps().flat_map(|y| steps().map(move |x| DVec2::new(x, y) * SUBPIXEL_RADIUS_PX));
        let mut values = offsets.filter_map(|offset| self.truth(pixel, offset));
        values.next().is_some_and(|first| values.any(|truth| truth != first))
    }

    /// Reference next to a pixel's centre; `None` where its plane is not sampled.
    fn truth(&self, pixel: usize, offset_px: DVec2) -> Option<f32> {
        let position = self.planes.point(pixel, offset_px)?.as_vec3();
        let geometric_normal = self.planes.surfaces.normals[pixel];
        let receiver =
            ReceiverPoint { position, geometric_normal, view_distance_m: position.distance(self.eye) };
        Some(mean(trace_hard(self.rays, &self.light.shape, &receiver, false).visibility))
    }
}

/// The tangent planes of the surfaces of a view, between the centres of pixels.
pub(super) struct PixelPlanes<'a> {
    surfaces: &'a Surfaces,
    origin_world: DVec3,
    world_from_clip: DMat4,
}

impl<'a> PixelPlanes<'a> {
    /// `origin_world`: that of the surfaces.
    pub(super) fn new(surfaces: &'a Surfaces, options: &ViewOptions, origin_world: DVec3) -> Self {
        let camera = &options.camera;
        let clip_from_world = camera.clip_from_view(options.aspect()) * camera.view_from_world();
        Self { surfaces, origin_world, world_from_clip: clip_from_world.inverse() }
    }

    /// Returns the point of a pixel's tangent plane at an offset from its centre, relative to the frame's origin.
    pub(super) fn point(&self, pixel: usize, offset_px: DVec2) -> Option<DVec3> {
        let [width, height] = self.surfaces.size_px;
        let (x, y) = (pixel as u32 % width, pixel as u32 / width);
        let size = DVec2::new(f64::from(width), f64::from(height));
        let uv = (DVec2::new(f64::from(x), f64::from(y)) + 0.5 + offset_px) / size;
        let point_at = |depth| {
            let ndc = DVec3::new(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, depth);
            self.world_from_clip.project_point3(ndc) - self.origin_world
        };
        // Two points on the ray through the image.
        let (start, direction) = (point_at(1.0), point_at(0.5) - point_at(1.0));
        let (position, normal) =
            (self.surfaces.positions[pixel].as_dvec3(), self.surfaces.normals[pixel].as_dvec3());
        let distance = (position - start).dot(normal) / direction.dot(normal);
        (distance.is_finite() && distance > 0.0).then(|| start + direction * distance)
    }
}
