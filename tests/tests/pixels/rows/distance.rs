//! Where shadows begin and end.

use glam::DVec3;
use shadowgraph::shadows::{CascadeSelection, DistanceMeasure, PCF, RAYTRACED, SDSM, ShadowSettings};

use super::{count, cube_under_spot, greys, greys_with, pillar_view, pillars, plan};
use crate::stage::{camera, gpu, sun, sun_direction, view};

#[test]
fn row_42_the_distance_from_the_camera_does_not_depend_on_where_it_looks() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_under_spot();
    scene.insert_light(sun(sun_direction(40.0, 250.0)));
    let eye = super::at_cube().position_world();
    let to_cube = DVec3::new(0.0, 0.5, 0.0) - eye;
    let distance_m = (to_cube.length() - 1.5) as f32;
    for light in 0..2 {
        let dark = |measure, turn: f64| {
            let mut options =
                view(camera(eye, eye + glam::DQuat::from_rotation_y(turn) * to_cube), distance_m);
            options.shadows.fade_fraction = 0.001;
            options.shadows.measure = measure;
            count(&greys(gpu, &scene, light, &options), |grey| grey < 255)
        };
        // Off the view's axis, the same point has less view depth.
        let by_depth = [0.0, 0.6].map(|turn| dark(DistanceMeasure::ViewDepth, turn));
        assert!(by_depth[0] == 0 && by_depth[1] > 50, "light {light}: {by_depth:?}");
        let by_radius = [0.0, 0.6].map(|turn| dark(DistanceMeasure::Radius, turn));
        assert_eq!(by_radius, [0, 0], "light {light}");
    }
}

#[test]
fn row_45_cascades_that_begin_late_have_finer_texels_far_away() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    let options = |begin_m: f32, select| {
        pillar_view(|settings: &mut ShadowSettings| {
            settings.cascades.map_size_px = 1024;
            settings.cascades.begin_m = begin_m;
            settings.cascades.select = select;
        })
    };
    let texel_at_40_m = |begin_m| {
        let views = plan(&scene, &options(begin_m, CascadeSelection::Depth)).views;
        views.iter().find(|view| view.end_m > 40.0).unwrap().texel_world
    };
    let [early, late] = [0.0, 15.0].map(texel_at_40_m);
    assert!(late < 0.8 * early, "{early} {late}");
    for technique in [PCF, SDSM] {
        for select in [CascadeSelection::Map, CascadeSelection::Sphere, CascadeSelection::Depth] {
            // Points in front of the first cascade have shadows too.
            let dark = |technique| {
                let greys = greys_with(gpu, &scene, 0, &options(15.0, select), technique);
                count(&greys, |grey| grey < 128)
            };
            let (shown, truth) = (dark(technique), dark(RAYTRACED));
            assert!(shown.abs_diff(truth) * 8 < truth, "{technique:?} {select:?}: {shown} {truth}");
        }
    }
}

#[test]
fn row_57_every_cascade_shows_a_visible_point() {
    let Some(gpu) = gpu() else { return };
    // The camera is above a floor, and sees none of it for several metres.
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    let depth = CascadeSelection::Depth;
    // By map, a finer cascade is looked up as far as its map reaches, which may be to the end of a short distance.
    for (distance_m, select) in [(15.0, depth), (60.0, depth), (60.0, CascadeSelection::Map)] {
        let options = pillar_view(|settings: &mut ShadowSettings| {
            settings.distance_m = distance_m;
            settings.fade_fraction = 0.001;
            settings.cascades.select = select;
        });
        let colours = super::cascades::colours(gpu, scene.clone(), &options, 20);
        assert_eq!(colours, 4, "{distance_m} m, {select:?}");
    }
}
