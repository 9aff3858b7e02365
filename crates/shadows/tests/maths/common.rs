//! Scenes and a CPU reference of `pcf.wgsl`.

use glam::{DVec2, DVec3, DVec4, Vec3};
use shadowgraph_scene::{Aabb, Camera, CullVolume, Light, LightKind, Projection};
use shadowgraph_shadows::{CasterView, ShadowCasters, ShadowFilter, ShadowLight, ShadowView, filter_taps};

/// Boxes as casters.
pub(crate) struct Boxes(pub(crate) Vec<Aabb>);

impl ShadowCasters for Boxes {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        let touching = (0u32..).zip(&self.0).filter(|(_, bounds)| volume.intersects(bounds));
        casters.extend(touching.map(|(index, _)| index));
    }

    fn bounds(&self) -> Aabb {
        self.0.iter().fold(Aabb::EMPTY, |all, bounds| all.union(bounds))
    }

    fn draw(&self, _: &mut wgpu::RenderPass<'_>, _: &CasterView, _: &[u32]) -> u32 {
        0
    }
}

pub(crate) fn cube(center: DVec3, side: f64) -> Aabb {
    Aabb { min: center - side * 0.5, max: center + side * 0.5 }
}

pub(crate) fn sun(direction: DVec3, lux: f32) -> Light {
    light(LightKind::Directional { direction }, lux)
}

pub(crate) fn spot(position_world: DVec3, direction: DVec3, range: f64, outer_angle: f64) -> Light {
    let kind = LightKind::Spot {
        position_world,
        direction,
        range: Some(range),
        inner_angle: outer_angle * 0.5,
        outer_angle,
    };
    light(kind, 1000.0)
}

pub(crate) fn light(kind: LightKind, intensity: f32) -> Light {
    Light { name: None, kind, color: Vec3::ONE, intensity, casts_shadow: true }
}

pub(crate) fn camera(eye: DVec3, target: DVec3) -> Camera {
    let projection = Projection::Perspective { fov_y: 60f64.to_radians(), near: 0.1, far: Some(1000.0) };
    Camera::look_at(eye, target, DVec3::Y, projection)
}

/// A receiver on a plane. World space is relative to the frame's origin.
#[derive(Clone, Copy)]
pub(crate) struct Receiver {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
}

/// Returns the visibility that `pcf.wgsl` computes from a map whose texels are `stored(x, y)`; `None` if the view does not
/// cover the receiver.
pub(crate) fn visibility(
    view: &ShadowView,
    light: &ShadowLight,
    map_size_px: [u32; 2],
    receiver: Receiver,
    stored: &dyn Fn(i64, i64) -> f64,
) -> Option<f64> {
    let lookup = Lookup::new(view, light, receiver)?;
    let map = DVec2::new(f64::from(map_size_px[0]), f64::from(map_size_px[1]));
    Some(lookup.tent(lookup.uv * map, stored))
}

pub(crate) struct Lookup {
    pub(crate) uv: DVec2,
    pub(crate) depth: f64,
    pub(crate) slope: DVec2,
    pub(crate) min_slope: f64,
}

impl Lookup {
    pub(crate) fn new(view: &ShadowView, light: &ShadowLight, receiver: Receiver) -> Option<Self> {
        let map_from_world = view.map_from_world.as_dmat4();
        let at = view.light.as_dvec4();
        let to_light = at.truncate() - receiver.position * at.w;
        let cosine = receiver.normal.dot(to_light.normalize());
        let w = (map_from_world * receiver.position.extend(1.0)).w.max(0.0);
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let offset_m = f64::from(light.normal_bias_texels * view.texel_world) * w * sine;
        let moved: DVec4 = map_from_world * (receiver.position + receiver.normal * offset_m).extend(1.0);
        if moved.w <= 0.0 {
            return None;
        }
        let (uv, depth) = (moved.truncate().truncate() / moved.w, moved.z / moved.w);
        let depth_per_texel = f64::from(view.depth_per_texel) / moved.w;
        let across = (view.clip_from_world.as_dmat4() * receiver.normal.extend(0.0)).truncate().truncate()
            * f64::from(view.axis_scale);
        let facing = receiver.normal.dot(to_light).max(1e-4);
        let slope = DVec2::new(-across.x, across.y) * f64::from(view.depth_per_texel) / facing;
        let steepest = f64::from(light.max_slope) * depth_per_texel;
        let slope = slope * f64::from(light.slope_bias) * steepest / slope.length().max(steepest);
        let inside = uv.cmpge(view.uv_min.as_dvec2()).all() && uv.cmple(view.uv_max.as_dvec2()).all();
        let rise = f64::from(light.filter_taps) * (slope.x.abs() + slope.y.abs());
        if !(inside && (depth > 0.0 || view.is_open == 1) && depth + rise < 0.999_999) {
            return None;
        }
        let depth = depth.max(0.0);
        Some(Self {
            uv,
            depth: depth + f64::from(light.depth_bias_texels) * depth_per_texel,
            slope,
            min_slope: f64::from(light.min_slope) * depth_per_texel,
        })
    }

    fn tent(&self, at: DVec2, stored: &dyn Fn(i64, i64) -> f64) -> f64 {
        let base = (at + 0.5).floor() - 0.5;
        let s = at - base;
        let taps = |s: f64| filter_taps(ShadowFilter::Tent5, 1.0, s).enumerate();
        let rise = |tap: usize, s: f64, slope: f64| {
            let first = tap as f64 * 2.0 - 2.0;
            ((first - s) * slope).max((first + 1.0 - s) * slope)
        };
        let mut sum = 0.0;
        for (j, (weight_y, tap_y)) in taps(s.y) {
            for (i, (weight_x, tap_x)) in taps(s.x) {
                let rise = rise(i, s.x, self.slope.x) + rise(j, s.y, self.slope.y);
                let cone = ((DVec2::new(tap_x, tap_y) - s).length() + 0.5) * self.min_slope;
                let depth = (self.depth + rise.abs().max(cone)).min(0.999_999);
                let point = base + DVec2::new(tap_x, tap_y);
                sum += weight_x * weight_y * bilinear_comparison(point, depth, stored);
            }
        }
        sum
    }
}

/// Returns the result of the comparison sampler: four comparisons (GreaterEqual), interpolated between their centres.
fn bilinear_comparison(point: DVec2, depth: f64, stored: &dyn Fn(i64, i64) -> f64) -> f64 {
    let corner = (point - 0.5).floor();
    let weight = point - 0.5 - corner;
    let lit = |x: i64, y: i64| f64::from(u8::from(depth >= stored(corner.x as i64 + x, corner.y as i64 + y)));
    let top = lit(0, 0) * (1.0 - weight.x) + lit(1, 0) * weight.x;
    let bottom = lit(0, 1) * (1.0 - weight.x) + lit(1, 1) * weight.x;
    top * (1.0 - weight.y) + bottom * weight.y
}

/// Returns the distance at which a ray first hits a box after `from`, in lengths of `direction`.
pub(crate) fn hit_box(bounds: &Aabb, origin: DVec3, direction: DVec3, from: f64) -> Option<f64> {
    let (a, b) = ((bounds.min - origin) / direction, (bounds.max - origin) / direction);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    (enter <= leave && leave > from).then_some(enter.max(from))
}

/// A light above a block on a floor: the contents of its map, and the exact shadow.
pub(crate) struct Analytic {
    pub(crate) floor: f64,
    pub(crate) block: Aabb,
    pub(crate) view: ShadowView,
    pub(crate) light: ShadowLight,
    pub(crate) map_size_px: [u32; 2],
}

impl Analytic {
    /// Returns the depth in a texel of the map: that of the first surface along the light through the texel's centre.
    pub(crate) fn stored(&self, x: i64, y: i64) -> f64 {
        let map_from_world = self.view.map_from_world.as_dmat4();
        let texel = DVec2::new(x as f64, y as f64) + 0.5;
        let uv = texel / DVec2::new(f64::from(self.map_size_px[0]), f64::from(self.map_size_px[1]));
        let through = map_from_world.inverse().project_point3(uv.extend(0.5));
        let ray = -self.to_light(through);
        // Far enough back to be in front of everything.
        let start = if self.view.light.w > 0.0 { through - ray } else { through - ray * 1000.0 };
        let floor = (self.floor - start.y) / ray.y;
        let floor = if floor > 0.0 { floor } else { f64::INFINITY };
        let first = hit_box(&self.block, start, ray, 0.0).unwrap_or(f64::INFINITY).min(floor);
        if first.is_finite() {
            map_from_world.project_point3(start + ray * first).z.clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    /// Returns the visibility that the shader computes, 0 to 1; `None` outside the tile.
    pub(crate) fn visibility(&self, receiver: Receiver) -> Option<f64> {
        let stored = |x: i64, y: i64| self.stored(x, y);
        visibility(&self.view, &self.light, self.map_size_px, receiver, &stored)
    }

    /// Returns whether the block is between the point and the light.
    pub(crate) fn in_shadow(&self, receiver: Receiver) -> bool {
        let start = receiver.position + receiver.normal * 1e-7;
        hit_box(&self.block, start, self.to_light(start), 0.0).is_some()
    }

    /// Returns the vector to the light: unit length, or the whole distance to a spot light.
    pub(crate) fn to_light(&self, position: DVec3) -> DVec3 {
        let light = self.view.light.as_dvec4();
        light.truncate() - position * light.w
    }

    /// Returns the width of a texel at a point, metres.
    pub(crate) fn texel_m(&self, position: DVec3) -> f64 {
        let w = (self.view.map_from_world.as_dmat4() * position.extend(1.0)).w;
        f64::from(self.view.texel_world) * w
    }

    /// Returns whether the outline of the shadow passes within this many texels of the point, measured across the light.
    /// `is_on_surface` returns whether a point of the plane belongs to the surface.
    pub(crate) fn near_outline(
        &self,
        receiver: Receiver,
        texels: f64,
        is_on_surface: &dyn Fn(DVec3) -> bool,
    ) -> bool {
        let Receiver { position, normal } = receiver;
        let expected = self.in_shadow(receiver);
        let to_light = self.to_light(position);
        let (right, up) = to_light.normalize().any_orthonormal_pair();
        let distance = texels * self.texel_m(position);
        (0..24).any(|step| {
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 24.0).sin_cos();
            let nearby = position + (right * cos + up * sin) * distance;
            let ray = self.to_light(nearby);
            let at = nearby + ray * ((position - nearby).dot(normal) / ray.dot(normal));
            is_on_surface(at) && self.in_shadow(Receiver { position: at, normal }) != expected
        })
    }
}
