//! How large the shadow texels are that shade each pixel.

use glam::{DMat4, DVec2, DVec3, Vec3};
use shadowgraph_shadows::{SELECT_DEPTH, SELECT_MAP, SELECT_SPHERE, ShadowLight, ShadowPlan, ShadowView};

use super::Surfaces;
use shadowgraph::ViewOptions;

/// The texels that shade each pixel, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    /// The side of a texel, metres, square to the light; 0 where no map covers the surface.
    pub side_m: Vec<f32>,
    /// How many pixels a texel reaches over at most, where its light falls onto the surface; 0 likewise.
    pub reach_px: Vec<f32>,
    /// Which of the light's views it is, from 0, the finest; [`NO_VIEW`] likewise.
    pub views: Vec<u32>,
}

/// In [`Texels::views`]: no map covers the surface.
pub const NO_VIEW: u32 = u32::MAX;

impl Texels {
    /// Finds the texels of one light's maps. `origin_world` is what the plan's and the surfaces' positions are relative
    /// to.
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
        let screen = Screen { clip_from_position, size_px: DVec2::from(options.size_px.map(f64::from)) };
        let selected = Selected::new(plan.lights.get(light), options, origin_world);
        let pixels = surfaces.positions.iter().zip(&surfaces.normals);
        let mut texels = Self { side_m: Vec::new(), reach_px: Vec::new(), views: Vec::new() };
        for (position, normal) in pixels {
            let candidates = (0..).zip(views).filter(|(_, view)| selected.may_be(view, *position));
            let mut found = candidates.filter_map(|(index, view)| Some((index, side_m(view, *position)?)));
            let found = found.next();
            let (view, side_m, reach_px) = match found {
                Some((view, (side_m, to_light))) if *normal != Vec3::ZERO => {
                    (view, side_m, screen.reach_px(*position, *normal, to_light, side_m))
                }
                _ => (NO_VIEW, 0.0, 0.0),
            };
            texels.views.push(view);
            texels.side_m.push(side_m);
            texels.reach_px.push(reach_px);
        }
        texels
    }
}

/// The side of a view's texels at a position, and the unit way to the light; `None` if it does not cover it.
fn side_m(view: &ShadowView, position: Vec3) -> Option<(f32, Vec3)> {
    let map = view.map_from_world * position.extend(1.0);
    let inside = |uv: glam::Vec2| uv.cmpge(view.uv_min).all() && uv.cmple(view.uv_max).all();
    let covered = map.w > 0.0 && inside(map.truncate().truncate() / map.w) && map.z > 0.0;
    let to_light = view.light.truncate() - position * view.light.w;
    covered.then_some((view.texel_world * map.w, to_light.normalize_or(Vec3::Y)))
}

/// How a light's views are chosen, as far as it is not by what covers a point.
struct Selected {
    select: u32,
    view_from_position: DMat4,
}

impl Selected {
    fn new(light: Option<&ShadowLight>, options: &ViewOptions, origin_world: DVec3) -> Self {
        let view_from_position = options.camera.view_from_world() * DMat4::from_translation(origin_world);
        Self { select: light.map_or(SELECT_MAP, |light| light.select), view_from_position }
    }

    fn may_be(&self, view: &ShadowView, position: Vec3) -> bool {
        match self.select {
            SELECT_SPHERE => position.distance(view.center) < view.radius,
            SELECT_DEPTH => {
                -self.view_from_position.transform_point3(position.as_dvec3()).z < f64::from(view.end_m)
            }
            _ => true,
        }
    }
}

struct Screen {
    clip_from_position: DMat4,
    size_px: DVec2,
}

impl Screen {
    fn pixel(&self, position: DVec3) -> Option<DVec2> {
        let clip = self.clip_from_position * position.extend(1.0);
        let ndc = clip.truncate().truncate() / clip.w;
        (clip.w > 1e-9).then_some(ndc * self.size_px * DVec2::new(0.5, -0.5))
    }

    /// The farther of the pixels that the two axes of a texel come to lie at, if they are cast onto the surface.
    fn reach_px(&self, position: Vec3, normal: Vec3, to_light: Vec3, side_m: f32) -> f32 {
        let (position, normal, to_light) = (position.as_dvec3(), normal.as_dvec3(), to_light.as_dvec3());
        // Towards the edge of the lit side a texel is drawn out without end.
        let facing = normal.dot(to_light).max(0.02);
        let Some(here) = self.pixel(position) else { return 0.0 };
        let (across, along) = to_light.any_orthonormal_pair();
        let reach = [across, along].map(|axis| {
            let on_surface = (axis - to_light * (axis.dot(normal) / facing)) * f64::from(side_m);
            self.pixel(position + on_surface).map_or(0.0, |there| there.distance(here))
        });
        reach[0].max(reach[1]) as f32
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    /// A camera 10 m over the ground that looks straight down and sees 20 m of it in 100 pixels.
    fn screen() -> Screen {
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
        Screen { clip_from_position: projection * view, size_px: DVec2::splat(100.0) }
    }

    #[test]
    fn under_a_steep_light_a_texel_reaches_as_far_as_its_side() {
        let reach = screen().reach_px(Vec3::ZERO, Vec3::Y, Vec3::Y, 0.4);
        assert!((reach - 2.0).abs() < 1e-3, "{reach}");
    }

    #[test]
    fn a_low_light_draws_its_texels_out() {
        let low = Vec3::new(30f32.to_radians().cos(), 30f32.to_radians().sin(), 0.0);
        let reach = screen().reach_px(Vec3::ZERO, Vec3::Y, low, 0.4);
        // The axis in the plane of incidence is cast over twice its length; which axes are taken, is open.
        assert!((2.0..=4.01).contains(&reach) && reach > 2.5, "{reach}");
    }
}
