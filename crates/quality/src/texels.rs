//! Size of the shadow texels of each pixel.

use glam::{DMat4, DVec2, DVec3, Vec3};
use shadowgraph_shadows::{SELECT_DEPTH, SELECT_MAP, SELECT_SPHERE, ShadowLight, ShadowPlan, ShadowView};

use super::Surfaces;
use shadowgraph::ViewOptions;

/// The shadow texels of each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    /// Size of a texel perpendicular to the light, metres; 0 where no map covers the surface.
    pub side_m: Vec<f32>,
    /// Largest extent on screen of a texel projected onto the surface, pixels; 0 likewise.
    pub extent_px: Vec<f32>,
    /// Index of the light's view, from 0, the finest; [`NO_VIEW`] likewise.
    pub views: Vec<u32>,
}

/// Value of [`Texels::views`] where no map covers the surface.
pub const NO_VIEW: u32 = u32::MAX;

impl Texels {
    /// Computes the texels of one light's maps. `origin_world` is the origin of the positions of plan and surfaces.
    #[must_use]
    pub fn new(
        surfaces: &Surfaces,
        plan: &ShadowPlan,
        light: usize,
        options: &ViewOptions,
        origin_world: DVec3,
    ) -> Self {
        let views = plan.lights.get(light).map_or(&[][..], |light| {
            let (first, count) = (light.first_view as usize, light.view_count as usize);
            plan.views.get(first..first + count).unwrap_or_default()
        });
        let from_origin = DMat4::from_translation(origin_world);
        let camera = &options.camera;
        let clip_from_position =
            camera.clip_from_view(options.aspect()) * camera.view_from_world() * from_origin;
        let screen =
            ScreenProjection { clip_from_position, size_px: DVec2::from(options.size_px.map(f64::from)) };
        let selection = ViewSelection::new(plan.lights.get(light), views, options, origin_world);
        let pixels = surfaces.positions.iter().zip(&surfaces.normals);
        let mut texels = Self { side_m: Vec::new(), extent_px: Vec::new(), views: Vec::new() };
        for (position, normal) in pixels {
            let candidates = (0..).zip(views).filter(|(_, view)| selection.allows(view, *position));
            let mut candidate =
                candidates.filter_map(|(index, view)| Some((index, side_m(view, *position)?)));
            let candidate = candidate.next();
            let (view, side_m, extent_px) = match candidate {
                Some((view, (side_m, to_light))) if *normal != Vec3::ZERO => {
                    (view, side_m, screen.extent_px(*position, *normal, to_light, side_m))
                }
                _ => (NO_VIEW, 0.0, 0.0),
            };
            texels.views.push(view);
            texels.side_m.push(side_m);
            texels.extent_px.push(extent_px);
        }
        texels
    }
}

/// Returns the size of a view's texels at a position and the unit direction to the light; `None` if it does not cover
/// the position.
fn side_m(view: &ShadowView, position: Vec3) -> Option<(f32, Vec3)> {
    let map = view.map_from_world * position.extend(1.0);
    let inside = |uv: glam::Vec2| uv.cmpge(view.uv_min).all() && uv.cmple(view.uv_max).all();
    let covered = map.w > 0.0 && inside(map.truncate().truncate() / map.w) && map.z > 0.0;
    let to_light = view.light.truncate() - position * view.light.w;
    covered.then_some((view.texel_world * map.w, to_light.normalize_or(Vec3::Y)))
}

/// Selection of a light's views by other criteria than coverage.
struct ViewSelection {
    select: u32,
    view_from_position: DMat4,
    /// View depth at which the first cascade begins, metres.
    begin_m: f32,
    /// The last cascade.
    last: u32,
}

impl ViewSelection {
    fn new(
        light: Option<&ShadowLight>,
        views: &[ShadowView],
        options: &ViewOptions,
        origin_world: DVec3,
    ) -> Self {
        Self {
            select: light.map_or(SELECT_MAP, |light| light.select),
            view_from_position: options.camera.view_from_world() * DMat4::from_translation(origin_world),
            begin_m: views.first().map_or(0.0, |view| view.begin_m),
            last: views.last().map_or(0, |view| view.cascade),
        }
    }

    fn allows(&self, view: &ShadowView, position: Vec3) -> bool {
        match self.select {
            SELECT_SPHERE => position.distance(view.center) < view.radius,
            SELECT_DEPTH => {
                let depth_m = -self.view_from_position.transform_point3(position.as_dvec3()).z as f32;
                depth_m < view.end_m && (depth_m >= self.begin_m || view.cascade == self.last)
            }
            _ => true,
        }
    }
}

struct ScreenProjection {
    clip_from_position: DMat4,
    size_px: DVec2,
}

impl ScreenProjection {
    fn pixel(&self, position: DVec3) -> Option<DVec2> {
        let clip = self.clip_from_position * position.extend(1.0);
        let ndc = clip.truncate().truncate() / clip.w;
        (clip.w > 1e-9).then_some(ndc * self.size_px * DVec2::new(0.5, -0.5))
    }

    /// Returns the larger extent on screen of the two axes of a texel, projected along the light onto the surface.
    fn extent_px(&self, position: Vec3, normal: Vec3, to_light: Vec3, side_m: f32) -> f32 {
        let (position, normal, to_light) = (position.as_dvec3(), normal.as_dvec3(), to_light.as_dvec3());
        // Towards the terminator the projected texel grows without limit.
        let facing = normal.dot(to_light).max(0.02);
        let Some(here) = self.pixel(position) else { return 0.0 };
        let (across, along) = to_light.any_orthonormal_pair();
        let extent = [across, along].map(|axis| {
            let on_surface = (axis - to_light * (axis.dot(normal) / facing)) * f64::from(side_m);
            self.pixel(position + on_surface).map_or(0.0, |there| there.distance(here))
        });
        extent[0].max(extent[1]) as f32
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// A camera 10 m over the ground that looks straight down and sees 20 m of it in 100 pixels.
    fn screen() -> ScreenProjection {
        let projection = DMat4::from_cols_array_2d(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 0.1, 0.0],
        ]);
        let view = DMat4::from_rows(
            DVec3::X.extend(0.0),
            DVec3::NEG_Z.extend(0.0),
            DVec3::Y.extend(-10.0),
            DVec3::ZERO.extend(1.0),
        );
        ScreenProjection { clip_from_position: projection * view, size_px: DVec2::splat(100.0) }
    }

    #[test]
    fn under_a_steep_light_the_extent_of_a_texel_is_its_size() {
        let extent = screen().extent_px(Vec3::ZERO, Vec3::Y, Vec3::Y, 0.4);
        assert!((extent - 2.0).abs() < 1e-3, "{extent}");
    }

    #[test]
    fn a_low_light_stretches_its_texels() {
        let low = Vec3::new(30f32.to_radians().cos(), 30f32.to_radians().sin(), 0.0);
        let extent = screen().extent_px(Vec3::ZERO, Vec3::Y, low, 0.4);
        // The axis in the plane of incidence is stretched to twice its length; the choice of axes is arbitrary.
        assert!((2.0..=4.01).contains(&extent) && extent > 2.5, "{extent}");
    }
}
