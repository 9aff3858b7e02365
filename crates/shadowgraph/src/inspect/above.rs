//! Cameras, cascades and shadow maps from above.

use glam::{DVec2, DVec3, Vec3, Vec4};
use shadowgraph_inspect::{Drawing, Outline};
use shadowgraph_scene::Light;
use shadowgraph_shadows::{NOT_A_CASCADE, ShadowView};

use super::InspectedFrame;
use crate::view_options::ViewOptions;

/// Returns the outlines of the camera's frustum up to the shadow distance, and of the volumes of its shadow maps: +X to the right,
/// +Z down, metres from the camera. `None` without maps.
pub(super) fn from_above(
    inspected: &InspectedFrame,
    lights: &[Light],
    options: &ViewOptions,
) -> Option<Drawing> {
    let origin = shadowgraph_scene::origin_near(options.camera.position_world());
    let eye = options.camera.position_world() - origin;
    let flat = |point: DVec3| DVec2::new(point.x - eye.x, point.z - eye.z);
    let mut outlines = vec![Outline { name: "camera".into(), points: camera(options, flat, origin) }];
    for (light, range) in inspected.lights.iter().enumerate() {
        let first = range.first_view as usize;
        let views = inspected.views.iter().skip(first).take(range.view_count as usize);
        let several = range.view_count > 1;
        for (number, view) in views.enumerate().filter(|(_, view)| view.radius > 0.0) {
            let name = name(light, lights, view, several.then_some(number));
            outlines
                .push(Outline { name, points: hull(corners(view).map(|corner| flat(corner.as_dvec3()))) });
        }
    }
    let caption = "Seen from above, +X to the right and +Z down: the camera's frustum up to the shadow distance, and the \
                   volumes of the shadow maps.";
    (outlines.len() > 1).then(|| Drawing {
        title: "Cameras and shadow maps from above".into(),
        caption: caption.into(),
        outlines,
    })
}

fn camera(options: &ViewOptions, flat: impl Fn(DVec3) -> DVec2, origin: DVec3) -> Vec<[f32; 2]> {
    let camera = &options.camera;
    let far = f64::from(options.shadows.distance_m).min(camera.far().unwrap_or(f64::INFINITY));
    let corners = camera.slice_corners_view(options.aspect(), camera.near(), far.max(camera.near() * 1.01));
    let world_from_view = camera.view_from_world().inverse();
    hull(corners.map(|corner| flat(world_from_view.transform_point3(corner) - origin)))
}

fn name(light: usize, lights: &[Light], view: &ShadowView, number: Option<usize>) -> String {
    // Named like the passes that draw the maps, followed by the light's name.
    let own = lights.get(light).and_then(|light| light.name.as_deref());
    let name = own.map_or(format!("light {light}"), |own| format!("light {light} ({own})"));
    match (view.cascade, number) {
        (NOT_A_CASCADE, None) => name,
        (NOT_A_CASCADE, Some(side)) => format!("{name}, {}", SIDES[side.min(5)]),
        (cascade, _) => format!("cascade {cascade}, {:.1} to {:.1} m", view.begin_m, view.end_m),
    }
}

const SIDES: [&str; 6] = ["+X", "-X", "+Y", "-Y", "+Z", "-Z"];

/// Returns the corners of a tile's volume, relative to the frame's origin.
fn corners(view: &ShadowView) -> [Vec3; 8] {
    let world_from_clip = view.clip_from_world.inverse();
    std::array::from_fn(|corner| {
        let side = |bit: usize| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let point =
            world_from_clip * Vec4::new(side(0), side(1), if corner & 4 == 0 { 0.0 } else { 1.0 }, 1.0);
        point.truncate() / point.w
    })
}

/// Returns the convex hull of points (Andrew's monotone chain, 1979).
fn hull(points: [DVec2; 8]) -> Vec<[f32; 2]> {
    let mut points: Vec<DVec2> = points.into_iter().filter(|point| point.is_finite()).collect();
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., a, b] = chain[..]
                && (b - a).perp_dot(point - a) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let lower = half(&mut points.iter().copied());
    let upper = half(&mut points.iter().rev().copied());
    let outline: Vec<[f32; 2]> = lower.into_iter().chain(upper).map(|point| point.as_vec2().into()).collect();
    match (outline.is_empty(), points.first()) {
        (true, first) => vec![first.map_or([0.0; 2], |point| point.as_vec2().into())],
        (false, _) => outline,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_of_a_box_has_its_corners_and_no_inner_points() {
        let corners =
            [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0), (1.0, 1.0), (2.0, 2.0), (2.0, 0.0), (4.0, 3.0)];
        let outline = hull(corners.map(|(x, y)| DVec2::new(x, y)));
        assert_eq!(outline, [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]);
    }

    #[test]
    fn equal_points_are_one_point() {
        assert_eq!(hull([DVec2::ONE; 8]), [[1.0, 1.0]]);
        assert_eq!(hull([DVec2::NAN; 8]), [[0.0, 0.0]]);
    }
}
