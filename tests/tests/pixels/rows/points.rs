//! Point lights.

use super::{count, cube_view, greys, plan, wrong};
use crate::stage::{add_cube, cube_on_floor, gpu, light, nth_instance, view};
use glam::DVec3;
use shadowgraph::scene::{LightKind, Scene};
use shadowgraph::shadows::{SELECT_FACE, TileKind};

/// Returns a point light in the middle of eight cubes, so that their shadows fall over all faces and edges of its cube map.
fn point_light_among_cubes() -> Scene {
    let mut scene = cube_on_floor(DVec3::new(2.0, 0.0, 0.0));
    for i in 1..8 {
        let (sin, cos) = (f64::from(i) * std::f64::consts::FRAC_PI_4).sin_cos();
        add_cube(&mut scene, DVec3::new(2.0 * cos, 0.0, 2.0 * sin));
    }
    let kind = LightKind::Point { position_world: DVec3::new(0.0, 1.6, 0.0), range: Some(15.0) };
    scene.insert_light(light(kind, 3000.0));
    scene
}

#[test]
fn row_37_point_lights_cast_shadows_in_all_directions() {
    let Some(gpu) = gpu() else { return };
    let scene = point_light_among_cubes();
    let mut options = cube_view(|_| ());
    let planned = plan(&scene, &options);
    let parts: Vec<_> = planned.atlas.as_ref().unwrap().tiles.iter().map(|tile| tile.kind).collect();
    assert_eq!(parts, [0, 1, 2, 3, 4, 5].map(TileKind::Face));
    assert_eq!((planned.lights[0].select, planned.lights[0].view_count), (SELECT_FACE, 6));
    for eye in [DVec3::new(0.0, 9.0, 0.1), DVec3::new(-6.0, 4.0, 5.0), DVec3::new(5.0, 3.0, -6.0)] {
        options.camera = crate::stage::camera(eye, DVec3::ZERO);
        let dark = count(&greys(gpu, &scene, 0, &options), |grey| grey < 3);
        let wrong = wrong(gpu, &scene, 0, &options);
        assert!(dark > 2000 && wrong * 60 < dark, "{eye}: {wrong} of {dark} dark pixels");
    }
}

#[test]
fn row_37_faces_meet_without_a_seam() {
    let Some(gpu) = gpu() else { return };
    // A point light above an empty floor: the edges of its lower faces cross the floor at 45 degrees.
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.remove_instance(nth_instance(&scene, 1)).unwrap();
    let kind = LightKind::Point { position_world: DVec3::new(0.1, 1.5, 0.2), range: Some(30.0) };
    scene.insert_light(light(kind, 3000.0));
    for filter in shadowgraph::shadows::ShadowFilter::ALL {
        let mut options = view(crate::stage::camera(DVec3::new(3.0, 6.0, 4.0), DVec3::ZERO), 40.0);
        options.shadows.atlas.filter = filter;
        // Coarse enough that a missing texel would be visible.
        options.shadows.atlas.map_size_px = 512;
        let lit = greys(gpu, &scene, 0, &options);
        assert_eq!(count(&lit, |grey| grey < 255), 0, "{filter:?}");
    }
}
