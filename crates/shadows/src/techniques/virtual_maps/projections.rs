//! The projections of lights, and the levels of their maps: `Projection` and `Level` of `shadows/pages.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec2, DVec3, DVec4, Vec3, Vec4};
use shadowgraph_scene::Camera;

use crate::spot::SpotFit;

/// Texels along a page without its border.
pub(super) const PAGE_TEXELS: f64 = 128.0;
/// Texels along a page with its border.
pub(super) const PAGE_PX: u32 = 136;
/// Number of levels of a directional light.
pub(super) const DIRECTIONAL_LEVELS: u32 = 16;
/// Pages along a level of a directional light, a power of two.
const DIRECTIONAL_SIDE: u32 = 128;
/// Entries of a directional light in the table.
pub(super) const DIRECTIONAL_ENTRIES: u32 = DIRECTIONAL_LEVELS * DIRECTIONAL_SIDE * DIRECTIONAL_SIDE;
/// The logarithm to base 2 of the number of pages along the finest level of a spot light or of a face of a point light.
const LOCAL_SIDE_SHIFT: u32 = 6;
/// Texels along that level.
pub(super) const LOCAL_TEXELS: u32 = (PAGE_TEXELS as u32) << LOCAL_SIDE_SHIFT;
/// Number of levels of a spot light or of a face of a point light. The last one is a single page.
pub(super) const LOCAL_LEVELS: u32 = LOCAL_SIDE_SHIFT + 1;
/// Entries of a spot light or of a face of a point light in the table.
pub(super) const LOCAL_ENTRIES: u32 = ((1 << (2 * LOCAL_LEVELS)) - 1) / 3;
/// `MAX_NARROWING` of `shadows/pages.wgsl`.
const MAX_NARROWING: f64 = 1.0;
/// The depth range of a level of a directional light, texels: a power of two.
const DEPTH_TEXELS: f64 = 131_072.0;
/// Steps in which that range follows the camera, as a fraction of it.
const DEPTH_STEP: f64 = 0.25;
/// The smallest difference of depths in a level of a directional light.
const DIRECTIONAL_DEPTH_STEP: f32 = 1.0 / 8_388_608.0;

/// A projection of a light, fixed in the world. Pages are kept while it stays the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Projection {
    /// That of a directional light.
    Directional {
        /// The rotation from world to light space, +Z towards the light.
        light_from_world: DMat3,
        /// See [`CasterTarget`](crate::CasterTarget).
        slope_bias_milli: u32,
    },
    /// That of a spot light, or of a face of a point light.
    Local {
        /// The map.
        fit: SpotFit,
        /// See [`CasterTarget`](crate::CasterTarget).
        slope_bias_milli: u32,
    },
}

/// `Projection` of `shadows/pages.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct GpuProjection {
    pub(super) x: Vec4,
    pub(super) y: Vec4,
    pub(super) z: Vec4,
    pub(super) w: Vec4,
    pub(super) center: Vec3,
    pub(super) range_m: f32,
    pub(super) right: Vec3,
    pub(super) texel_m: f32,
    pub(super) down: Vec3,
    pub(super) depth_per_texel: f32,
    pub(super) to_light: Vec3,
    pub(super) is_perspective: u32,
    pub(super) first_level: u32,
    pub(super) level_count: u32,
    pub(super) first_entry: u32,
    pub(super) version: u32,
    pub(super) light_radius: f32,
    pub(super) max_radius_m: f32,
    pub(super) soft_level: u32,
    pub(super) caster_slope_bias: f32,
}

/// `Level` of `shadows/pages.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct GpuLevel {
    pub(super) phase: [f32; 2],
    pub(super) base: [i32; 2],
    pub(super) first_page: [i32; 2],
    pub(super) depth_scale: f32,
    pub(super) depth_offset: f32,
    pub(super) first_entry: u32,
    pub(super) side_shift: u32,
    pub(super) exponent: i32,
    pub(super) depth_step: f32,
}

/// The camera, as far as levels depend on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Viewpoint {
    pub(super) origin_world: DVec3,
    pub(super) eye_world: DVec3,
    /// The exponent of the finest texels of directional lights: 2 to this power metres.
    pub(super) finest_exponent: i32,
}

impl Viewpoint {
    /// Returns the viewpoint of an image that is `height_px` high. The finest texels are as wide as the narrowest pixel at the near plane asks
    /// for, or wider so that the coarsest are `coarsest_m` wide.
    pub(super) fn new(
        camera: &Camera,
        height_px: u32,
        level_bias: f32,
        coarsest_m: f64,
        origin_world: DVec3,
    ) -> Self {
        let near_m = camera.near();
        let corners = camera.slice_corners_view(1.0, near_m, 2.0 * near_m.abs() + 1.0);
        let height_m = |corners: &[DVec3]| {
            let heights = corners.iter().map(|corner| corner.y);
            heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min)
        };
        let pixel_m = height_m(&corners[..4]) / f64::from(height_px.max(1));
        let from_near = (pixel_m.log2() + f64::from(level_bias) - MAX_NARROWING).floor();
        let from_coarsest = coarsest_m.log2().ceil() - f64::from(DIRECTIONAL_LEVELS - 1);
        let finest_exponent = from_near.max(from_coarsest).clamp(-60.0, 60.0) as i32;
        Self { origin_world, eye_world: camera.position_world(), finest_exponent }
    }
}

/// Returns how wide the coarsest texels of directional lights have to be, metres: their level reaches `distance_m`, and `budget` of its pages
/// cover receivers of this diameter.
pub(super) fn coarsest_texel_m(distance_m: f64, diameter_m: f64, budget: u32) -> f64 {
    // Half of the pages, less some at the edge.
    let reach = f64::from(DIRECTIONAL_SIDE / 2 - 4);
    // Receivers that are as wide as some pages touch one more.
    let side = f64::from(budget).sqrt().floor() - 1.0;
    (distance_m / reach).max(diameter_m / side.max(1.0)) / PAGE_TEXELS
}

impl Projection {
    /// Returns the number of levels.
    pub(super) fn level_count(&self) -> u32 {
        match self {
            Self::Directional { .. } => DIRECTIONAL_LEVELS,
            Self::Local { .. } => LOCAL_LEVELS,
        }
    }

    /// Returns what shaders read; entries, levels, the version and penumbrae are left to the caller.
    pub(super) fn gpu(&self, viewpoint: &Viewpoint) -> GpuProjection {
        let (gpu, slope_bias_milli) = match self {
            Self::Directional { light_from_world, slope_bias_milli } => {
                (directional(light_from_world, viewpoint), slope_bias_milli)
            }
            Self::Local { fit, slope_bias_milli } => (local(fit, viewpoint), slope_bias_milli),
        };
        GpuProjection { caster_slope_bias: 0.001 * *slope_bias_milli as f32, ..gpu }
    }
}

fn directional(light_from_world: &DMat3, viewpoint: &Viewpoint) -> GpuProjection {
    let Viewpoint { origin_world, eye_world, finest_exponent } = *viewpoint;
    let axes = light_from_world.transpose();
    let (right, down, to_light) = (axes.x_axis, -axes.y_axis, axes.z_axis);
    let texel_m = f64::from(finest_exponent).exp2();
    let eye = eye_world - origin_world;
    let center = DVec3::new(right.dot(eye) / texel_m, down.dot(eye) / texel_m, to_light.dot(eye));
    GpuProjection {
        x: (right / texel_m).extend(0.0).as_vec4(),
        y: (down / texel_m).extend(0.0).as_vec4(),
        z: to_light.extend(0.0).as_vec4(),
        w: Vec4::W,
        center: center.as_vec3(),
        right: right.as_vec3(),
        texel_m: texel_m as f32,
        down: down.as_vec3(),
        depth_per_texel: texel_m as f32,
        to_light: to_light.as_vec3(),
        level_count: DIRECTIONAL_LEVELS,
        ..GpuProjection::zeroed()
    }
}

fn local(fit: &SpotFit, viewpoint: &Viewpoint) -> GpuProjection {
    let clip = fit.clip_from_world(viewpoint.origin_world);
    let half = 0.5 * f64::from(LOCAL_TEXELS);
    let [x, y, z, w]: [DVec4; 4] = [clip.row(0), clip.row(1), clip.row(2), clip.row(3)];
    let axes = fit.light_from_world.transpose();
    GpuProjection {
        x: ((x + w) * half).as_vec4(),
        y: ((w - y) * half).as_vec4(),
        z: z.as_vec4(),
        w: w.as_vec4(),
        center: (fit.cone.position_world - viewpoint.origin_world).as_vec3(),
        range_m: fit.cone.range_m as f32,
        right: axes.x_axis.as_vec3(),
        texel_m: fit.texel_per_m() as f32,
        down: (-axes.y_axis).as_vec3(),
        depth_per_texel: (fit.depth_scale_m() * fit.texel_per_m()) as f32,
        to_light: axes.z_axis.as_vec3(),
        is_perspective: 1,
        level_count: LOCAL_LEVELS,
        ..GpuProjection::zeroed()
    }
}

/// A level of a directional light around the camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct DirectionalLevel {
    /// The width of a texel, metres.
    texel_m: f64,
    exponent: i32,
    /// The page of the frame's origin, and the origin in it, texels.
    origin_page: DVec2,
    phase: DVec2,
}

impl DirectionalLevel {
    pub(super) fn new(light_from_world: &DMat3, viewpoint: &Viewpoint, level: u32) -> Self {
        let exponent = viewpoint.finest_exponent + level as i32;
        let texel_m = f64::from(exponent).exp2();
        let at = map_position(light_from_world, viewpoint.origin_world) / texel_m;
        let origin_page = (at / PAGE_TEXELS).floor();
        Self { texel_m, exponent, origin_page, phase: at - origin_page * PAGE_TEXELS }
    }

    /// Returns the page of a position on the map's axes, metres from the world's origin, counted from that of the frame's origin.
    pub(super) fn page(&self, position_m: DVec2) -> [i32; 2] {
        let page = (position_m / (self.texel_m * PAGE_TEXELS)).floor() - self.origin_page;
        [page.x as i32, page.y as i32]
    }

    pub(super) fn gpu(&self, light_from_world: &DMat3, viewpoint: &Viewpoint) -> GpuLevel {
        let [x, y] = self.page(map_position(light_from_world, viewpoint.eye_world));
        let half = DIRECTIONAL_SIDE as i32 / 2;
        let side = f64::from(DIRECTIONAL_SIDE);
        let range_m = self.texel_m * DEPTH_TEXELS;
        let step_m = range_m * DEPTH_STEP;
        let along = |point: DVec3| light_from_world.row(2).dot(point);
        let far_m = (along(viewpoint.eye_world) / step_m).round() * step_m - 0.5 * range_m;
        let depth_offset = (along(viewpoint.origin_world) - far_m) / range_m;
        let slot = self.exponent.rem_euclid(DIRECTIONAL_LEVELS as i32) as u32;
        GpuLevel {
            phase: self.phase.as_vec2().to_array(),
            base: [self.origin_page.x, self.origin_page.y].map(|page| page.rem_euclid(side) as i32),
            first_page: [x - half, y - half],
            depth_scale: (1.0 / range_m) as f32,
            depth_offset: depth_offset as f32,
            first_entry: slot * DIRECTIONAL_SIDE * DIRECTIONAL_SIDE,
            side_shift: DIRECTIONAL_SIDE.ilog2(),
            exponent: self.exponent,
            depth_step: DIRECTIONAL_DEPTH_STEP * depth_offset.abs().max(1.0) as f32,
        }
    }
}

/// Returns a position on the axes of a directional light's maps, x right and y down, metres.
pub(super) fn map_position(light_from_world: &DMat3, position_world: DVec3) -> DVec2 {
    let position = *light_from_world * position_world;
    DVec2::new(position.x, -position.y)
}

/// Returns the levels of all spot lights and faces of point lights.
pub(super) fn local_levels() -> impl Iterator<Item = GpuLevel> {
    let mut first_entry = 0;
    (0..LOCAL_LEVELS).map(move |level| {
        let side_shift = LOCAL_SIDE_SHIFT - level;
        let own = first_entry;
        first_entry += 1 << (2 * side_shift);
        GpuLevel {
            depth_scale: 1.0,
            first_entry: own,
            side_shift,
            exponent: level as i32,
            ..GpuLevel::zeroed()
        }
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn structs_have_the_same_layout_in_wgsl_and_rust() {
        let module = shadowgraph_shaders::compose("pages_mark.wgsl", &[]).unwrap();
        shadowgraph_shaders::check_layout!(&module, "Projection", GpuProjection:
            x, y, z, w, center, range_m, right, texel_m, down, depth_per_texel, to_light, is_perspective, first_level, level_count,
            first_entry, version, light_radius, max_radius_m, soft_level, caster_slope_bias,
        )
        .unwrap();
        shadowgraph_shaders::check_layout!(&module, "Level", GpuLevel:
            phase, base, first_page, depth_scale, depth_offset, first_entry, side_shift, exponent, depth_step,
        )
        .unwrap();
    }

    #[test]
    fn the_pages_of_a_directional_light_are_fixed_to_the_world() {
        let light_from_world = crate::ortho::light_from_world(DVec3::new(0.3, -1.0, 0.2)).unwrap();
        let at = |origin_x: f64, eye_x: f64| Viewpoint {
            origin_world: DVec3::X * origin_x,
            eye_world: DVec3::X * eye_x,
            finest_exponent: -7,
        };
        let point = map_position(&light_from_world, DVec3::new(700.0, 3.0, -20.0));
        for number in [0, 5, 15] {
            // The entry and the position in the page of a point do not depend on the origin.
            let place = |viewpoint: Viewpoint| {
                let level = DirectionalLevel::new(&light_from_world, &viewpoint, number);
                let gpu = level.gpu(&light_from_world, &viewpoint);
                let page = level.page(point);
                [0, 1].map(|axis| (page[axis] + gpu.base[axis]).rem_euclid(DIRECTIONAL_SIDE as i32))
            };
            assert_eq!(place(at(0.0, 690.0)), place(at(1024.0, 690.0)), "{number}");
            // The camera is in the middle of the pages that have entries.
            let viewpoint = at(1024.0, 690.0);
            let level = DirectionalLevel::new(&light_from_world, &viewpoint, number);
            let gpu = level.gpu(&light_from_world, &viewpoint);
            let page = level.page(map_position(&light_from_world, viewpoint.eye_world));
            assert_eq!([0, 1].map(|axis| page[axis] - gpu.first_page[axis]), [64, 64]);
        }
    }

    #[test]
    fn the_finest_texels_are_as_wide_as_the_narrowest_pixel_at_the_near_plane() {
        use shadowgraph_scene::Projection as CameraProjection;
        let exponent = |near, level_bias, coarsest_m| {
            let projection = CameraProjection::Perspective { fov_y: 1.0, near, far: None };
            let camera = Camera::look_at(DVec3::ZERO, DVec3::X, DVec3::Y, projection);
            Viewpoint::new(&camera, 720, level_bias, coarsest_m, DVec3::ZERO).finest_exponent
        };
        // 2 x 0.1 x tan(0.5) / 720 = 0.15 mm, half as wide where the pixel is narrow on the map.
        assert_eq!(exponent(0.1, 0.0, 0.1), -14);
        assert_eq!(exponent(0.2, 0.0, 0.1), -13);
        assert_eq!(exponent(0.1, -1.5, 0.1), -16);
        assert_eq!(exponent(0.1, 4.0, 0.1), -10);
        // 16 levels.
        assert_eq!(exponent(1e-9, 0.0, 0.25), -17);
    }

    #[test]
    fn the_coarsest_level_covers_all_receivers_with_its_budget_of_pages() {
        // 60 pages to the side of the camera, and 9 of 10 along the receivers.
        assert_eq!(coarsest_texel_m(7680.0, 1.0, 112), 1.0);
        assert_eq!(coarsest_texel_m(1.0, 1152.0, 112), 1.0);
        assert_eq!(coarsest_texel_m(1.0, 128.0, 4), 1.0);
    }
}
