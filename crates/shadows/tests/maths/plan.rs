//! The maps, tiles and casters of lights.

use glam::DVec3;
use shadowgraph_scene::{Aabb, Camera, CameraError, Light, LightKind, Projection, origin_near};
use shadowgraph_shadows::{
    AtlasTiles, Error, LightRef, LightShadows, MAP_ATLAS, MAP_CASCADES, NOT_A_CASCADE, Requirements,
    ShadowFilter, ShadowInputs, ShadowLight, ShadowPlan, ShadowSettings, ShadowView, TileKind, Unshadowed,
    UnshadowedReason, plan_shadows, plan_shadows_after,
};

use crate::common::{Boxes, camera, cube, light, spot, sun};

pub(crate) const DOWN: DVec3 = DVec3::new(0.3, -1.0, 0.2);

pub(crate) fn default_camera() -> Camera {
    camera(DVec3::new(0.0, 2.0, 8.0), DVec3::ZERO)
}

pub(crate) fn try_plan(
    camera: &Camera,
    lights: &[Light],
    casters: &Boxes,
    settings: &ShadowSettings,
) -> Result<ShadowPlan, Error> {
    let origin_world = origin_near(camera.position_world());
    plan_shadows(&ShadowInputs { view: 0, camera, aspect: 1.5, lights, casters, origin_world, settings })
}

pub(crate) fn plan_with(lights: &[Light], casters: Vec<shadowgraph_scene::Aabb>) -> ShadowPlan {
    try_plan(&default_camera(), lights, &Boxes(casters), &ShadowSettings::default()).unwrap()
}

/// Plans with tiles of one size.
fn plan_even(lights: &[Light], casters: Vec<shadowgraph_scene::Aabb>) -> ShadowPlan {
    let mut settings = ShadowSettings::default();
    settings.atlas.tiles = AtlasTiles::Even;
    try_plan(&default_camera(), lights, &Boxes(casters), &settings).unwrap()
}

pub(crate) fn plan(lights: &[Light]) -> ShadowPlan {
    plan_with(lights, cube_in_a_wide_world())
}

/// Returns a cube at the origin, and one so far away that all cascades are needed.
pub(crate) fn cube_in_a_wide_world() -> Vec<Aabb> {
    vec![cube(DVec3::ZERO, 1.0), cube(DVec3::X * 5000.0, 1.0)]
}

fn spot_at(x: f64) -> Light {
    spot(DVec3::new(x, 4.0, 0.0), DVec3::new(-x, -4.0, 0.0), 12.0, 0.6)
}

fn reasons(plan: &ShadowPlan) -> Vec<(u32, UnshadowedReason)> {
    plan.unshadowed.iter().map(|u: &Unshadowed| (u.light, u.reason)).collect()
}

#[test]
fn without_shadows_the_plan_is_empty() {
    let no_shadow = Light { casts_shadow: false, ..sun(DOWN, 1.0) };
    for plan in [plan(&[]), plan(&[no_shadow]), plan_with(&[sun(DOWN, 1.0), spot_at(1.0)], vec![])] {
        assert!(plan.cascades.is_none() && plan.atlas.is_none() && plan.views.is_empty());
        assert!(plan.lights.iter().all(|light| *light == ShadowLight::default()));
        // Buffers cannot be empty.
        assert_eq!(plan.view_bytes(plan.variant()).len(), size_of::<ShadowView>());
        assert!(!plan.light_bytes(plan.variant()).is_empty());
    }
}

#[test]
fn the_brightest_directional_light_gets_the_cascades_and_others_a_tile() {
    let plan = plan(&[sun(DOWN, 10.0), sun(DVec3::NEG_Y, 90.0), sun(-DVec3::ONE, 20.0), spot_at(2.0)]);
    let cascades = plan.cascades.as_ref().unwrap();
    assert!(cascades.tiles.iter().all(|tile| tile.light == 1));
    assert_eq!(cascades.tiles[0].casters, [0]);
    assert_eq!(
        cascades.tiles.iter().map(|tile| tile.kind).collect::<Vec<_>>(),
        [0, 1, 2, 3].map(TileKind::Cascade)
    );
    let atlas = plan.atlas.as_ref().unwrap();
    assert_eq!(
        atlas.tiles.iter().map(|tile| (tile.light, tile.view)).collect::<Vec<_>>(),
        [(0, 4), (2, 5), (3, 6)]
    );
    assert_eq!(plan.views.len(), 7);
    let gpu_light =
        |light: usize| (plan.lights[light].map, plan.lights[light].first_view, plan.lights[light].view_count);
    assert_eq!(
        [gpu_light(0), gpu_light(1), gpu_light(2), gpu_light(3)],
        [(MAP_ATLAS, 4, 1), (MAP_CASCADES, 0, 4), (MAP_ATLAS, 5, 1), (MAP_ATLAS, 6, 1),]
    );
    // Those of a uniform block.
    assert_eq!(plan.view_bytes(plan.variant()).len(), 32 * 256);
    assert!(plan.unshadowed.is_empty());
}

#[test]
fn views_describe_their_tiles() {
    let plan = plan(&[sun(DOWN, 10.0), sun(DVec3::NEG_Y, 9.0), spot_at(2.0)]);
    for map in [plan.cascades.as_ref().unwrap(), plan.atlas.as_ref().unwrap()] {
        for tile in &map.tiles {
            let view = &plan.views[tile.view as usize];
            let rect = tile.rect;
            assert_eq!(view.tile_px, [rect.x, rect.y, rect.width, rect.height]);
            let cascade = if let TileKind::Cascade(cascade) = tile.kind { cascade } else { NOT_A_CASCADE };
            assert_eq!(view.cascade, cascade);
            assert_eq!((view.uv_min, view.uv_max), rect.inner_uv(map.size_px, 3));
            assert_eq!(view.light.w, if tile.light == 2 { 1.0 } else { 0.0 });
            assert!(view.map_from_world.is_finite() && view.radius > 0.0);
        }
    }
    // Finer texels nearby.
    assert!(plan.views[..4].windows(2).all(|pair| pair[0].texel_world < pair[1].texel_world));
}

#[test]
fn row_60_the_borders_of_tiles_hold_the_texels_that_find_creases() {
    for (filter, closed, border_px) in
        [(ShadowFilter::Tent2, true, 2), (ShadowFilter::Tent2, false, 1), (ShadowFilter::Tent7, true, 4)]
    {
        let mut settings = ShadowSettings { close_creases: closed, ..ShadowSettings::default() };
        settings.cascades.filter = filter;
        let casters = Boxes(cube_in_a_wide_world());
        let plan = try_plan(&default_camera(), &[sun(DOWN, 10.0)], &casters, &settings).unwrap();
        let map = plan.cascades.as_ref().unwrap();
        let view = &plan.views[0];
        let expected = map.tiles[0].rect.inner_uv(map.size_px, border_px);
        assert_eq!((view.uv_min, view.uv_max), expected, "{filter:?}, {closed}");
    }
}

#[test]
fn lights_that_cannot_have_shadows_are_reported() {
    let point = light(LightKind::Point { position_world: DVec3::Y, range: Some(-1.0) }, 10.0);
    let behind = spot(DVec3::new(0.0, 2.0, 500.0), DVec3::Z, 5.0, 0.5);
    let too_far = spot(DVec3::new(0.0, 2.0, -400.0), DVec3::NEG_Y, 5.0, 0.5);
    let alone = spot(DVec3::new(4.0, 2.0, 0.0), DVec3::NEG_Y, 3.0, 0.3);
    let broken = spot(DVec3::NAN, DVec3::NEG_Y, 3.0, 0.3);
    let bright_nan = Light { intensity: f32::NAN, ..sun(DOWN, 1.0) };
    let plan =
        plan(&[sun(DVec3::ZERO, 1.0), sun(DOWN, 0.0), bright_nan, behind, too_far, alone, broken, point]);
    use UnshadowedReason::{InvalidLight, NoCasterInRange, NoIntensity, OutOfView};
    assert_eq!(
        reasons(&plan),
        [
            (0, InvalidLight),
            (1, NoIntensity),
            (2, InvalidLight),
            (3, OutOfView),
            (4, OutOfView),
            (5, NoCasterInRange),
            (6, InvalidLight),
            (7, InvalidLight),
        ]
    );
    assert!(plan.cascades.is_none() && plan.atlas.is_none());
    assert!(plan.unshadowed.iter().all(|u| !u.reason.describe().is_empty()));
}

#[test]
fn row_07_seventeenth_light_is_reported_and_the_least_important_one() {
    let mut lights: Vec<Light> = (0..17).map(|i| spot_at(f64::from(i) * 0.2 - 1.7)).collect();
    // Small and far away: the least important one.
    lights[4] = spot(DVec3::new(0.0, 1.5, -30.0), DVec3::NEG_Y, 2.0, 0.5);
    let casters = vec![cube(DVec3::ZERO, 1.0), cube(DVec3::new(0.0, 0.0, -30.0), 1.0)];
    let plan = plan_even(&lights, casters);
    assert_eq!(reasons(&plan), [(4, UnshadowedReason::AtlasFull)]);
    let atlas = plan.atlas.unwrap();
    assert_eq!(atlas.tiles.len(), 16);
    assert!(atlas.tiles.windows(2).all(|pair| pair[0].light < pair[1].light));
    assert_eq!(plan.lights[4].view_count, 0);
}

#[test]
fn row_07_light_without_casters_gives_up_its_tile() {
    let alone = spot(DVec3::new(4.0, 2.0, 0.0), DVec3::NEG_Y, 3.0, 0.3);
    let with = plan(&[spot_at(1.0), alone.clone()]);
    assert_eq!(with.atlas.unwrap().tiles[0].rect.width, 2048, "one light has the whole map");
    let casters = vec![cube(DVec3::ZERO, 1.0), cube(DVec3::new(4.0, 0.0, 0.0), 1.0)];
    let both = plan_even(&[spot_at(1.0), alone], casters).atlas.unwrap();
    assert_eq!((both.size_px, both.tiles.len()), ([2048, 1024], 2));
    assert_eq!((both.tiles[0].casters.as_slice(), both.tiles[1].casters.as_slice()), (&[0][..], &[1][..]));
}

#[test]
fn equal_inputs_give_equal_plans() {
    let lights: Vec<Light> = (0..20).map(|i| spot_at(f64::from(i % 7))).chain([sun(DOWN, 1.0)]).collect();
    let (a, b) = (plan(&lights), plan(&lights));
    assert_eq!(a, b);
    assert_eq!(a.view_bytes(a.variant()), b.view_bytes(b.variant()));
}

#[test]
fn shadows_fade_out_at_the_distance_or_the_far_plane() {
    for (distance_m, end) in [(60.0, 60.0), (5000.0, 1000.0)] {
        let settings = ShadowSettings { distance_m, fade_fraction: 0.25, ..ShadowSettings::default() };
        let casters = Boxes(vec![cube(DVec3::ZERO, 1.0)]);
        let plan = try_plan(&default_camera(), &[sun(DOWN, 1.0), spot_at(1.0)], &casters, &settings).unwrap();
        for light in &plan.lights {
            assert_eq!(light.fade_end_m, end);
            assert_eq!((light.fade(0.0), light.fade(0.75 * end - 0.1), light.fade(end)), (1.0, 1.0, 0.0));
            assert_eq!(light.fade(2.0 * end), 0.0);
            assert!((light.fade(0.875 * end) - 0.5).abs() < 1e-4);
        }
    }
}

#[test]
fn a_view_that_begins_beyond_the_shadow_distance_has_no_shadows() {
    let projection = Projection::Perspective { fov_y: 1.0, near: 200.0, far: None };
    let camera = Camera::look_at(DVec3::new(0.0, 2.0, 8.0), DVec3::ZERO, DVec3::Y, projection);
    let casters = Boxes(vec![cube(DVec3::ZERO, 1.0)]);
    let plan = try_plan(&camera, &[sun(DOWN, 1.0)], &casters, &ShadowSettings::default()).unwrap();
    assert_eq!(reasons(&plan), [(0, UnshadowedReason::OutOfView)]);
}

#[test]
fn invalid_views_are_errors() {
    let (good, casters, settings) =
        (default_camera(), Boxes(vec![cube(DVec3::ZERO, 1.0)]), ShadowSettings::default());
    let inputs = ShadowInputs {
        view: 0,
        camera: &good,
        aspect: 1.5,
        lights: &[],
        casters: &casters,
        origin_world: DVec3::ZERO,
        settings: &settings,
    };
    for aspect in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let result = plan_shadows(&ShadowInputs { aspect, ..inputs });
        assert!(matches!(result, Err(Error::Camera(CameraError::Aspect(_)))), "{result:?}");
    }
    let mut invalid = default_camera();
    invalid.world_from_view.translation.x = f64::NAN;
    assert_eq!(
        plan_shadows(&ShadowInputs { camera: &invalid, ..inputs }),
        Err(Error::Camera(CameraError::Transform))
    );
    for (near, far) in [(5.0, 5.0), (5.0, 1.0), (5.0, f64::NAN), (0.0, 1.0), (-1.0, 1.0), (f64::NAN, 1.0)] {
        let flat = Projection::Perspective { fov_y: 1.0, near, far: Some(far) };
        let result = plan_shadows(&ShadowInputs {
            camera: &Camera { projection: flat, ..default_camera() },
            ..inputs
        });
        let allowed = matches!(result, Err(Error::Camera(CameraError::Near(_) | CameraError::Far { .. })));
        assert!(allowed, "{near} {far} {result:?}");
    }
    let wrong = ShadowSettings { distance_m: 0.0, ..ShadowSettings::default() };
    let error = plan_shadows(&ShadowInputs { settings: &wrong, ..inputs }).unwrap_err();
    assert!(error.to_string().contains("distance_m"));
}

#[test]
fn a_light_with_two_entries_is_an_error() {
    let entry = || LightShadows::new(LightRef::Index(0));
    let settings = ShadowSettings { lights: vec![entry(), entry()], ..ShadowSettings::default() };
    let result = try_plan(&default_camera(), &[sun(DOWN, 1.0)], &Boxes(Vec::new()), &settings).unwrap_err();
    assert_eq!(result, Error::DuplicateLight { entry: 1, light: 0 });
}

#[test]
fn light_at_the_camera_and_a_hemisphere_wide_spot_have_usable_views() {
    let at_camera = spot(default_camera().position_world(), DVec3::NEG_Z, 20.0, std::f64::consts::FRAC_PI_2);
    let plan = plan(&[at_camera]);
    assert_eq!(plan.views.len(), 1);
    assert!(plan.views[0].map_from_world.is_finite());
}

#[test]
fn requirements_contain_filter_and_bias() {
    let mut settings = ShadowSettings::default();
    settings.bias.normal_texels = 2.0;
    let requirements = ShadowPlan::all_lit(0, &settings).requirements;
    assert_eq!(
        (requirements.kernel_radius_texels, requirements.bias_texels, requirements.blocker_reach_m),
        (3.0, 2.0, 0.0)
    );
    assert_eq!(requirements.margin_px(), 6.0);
}

/// Returns spot and point lights over a row of small boxes, from near to far.
fn street_lights(count: usize) -> (Vec<Light>, Boxes) {
    let at = |i: usize| DVec3::new((i % 8) as f64 * 5.0 - 17.0, 3.0, -4.0 * (i / 8) as f64);
    let light_at = |i: usize| {
        if i.is_multiple_of(2) {
            return spot(at(i), DVec3::NEG_Y, 6.0, 0.8);
        }
        light(LightKind::Point { position_world: at(i), range: Some(6.0) }, 50.0)
    };
    let boxes = (0..count).map(|i| cube(at(i).with_y(0.5), 1.0)).collect();
    ((0..count).map(light_at).collect(), Boxes(boxes))
}

#[test]
fn row_38_sixty_four_spot_and_point_lights_share_one_atlas() {
    let (lights, casters) = street_lights(72);
    let mut settings = ShadowSettings::default();
    settings.atlas.map_size_px = 4096;
    let plan = try_plan(&default_camera(), &lights, &casters, &settings).unwrap();
    let shadowed = plan.lights.iter().filter(|light| light.view_count > 0).count();
    assert!(
        shadowed >= 64 && reasons(&plan).iter().all(|(_, reason)| *reason == UnshadowedReason::OutOfView),
        "{shadowed} {:?}",
        reasons(&plan)
    );
    // Nearer lights have larger tiles, and no tiles overlap.
    let tiles = &plan.atlas.as_ref().unwrap().tiles;
    let width = |light: u32| tiles.iter().find(|tile| tile.light == light).map(|tile| tile.rect.width);
    assert!(width(2) > width(66), "{:?} {:?}", width(2), width(66));
    assert!(tiles.iter().enumerate().all(|(i, a)| tiles[..i].iter().all(|b| !a.rect.overlaps(&b.rect))));
    settings.atlas.tiles = AtlasTiles::Even;
    let even = try_plan(&default_camera(), &lights, &casters, &settings).unwrap();
    assert!(even.lights.iter().filter(|light| light.view_count > 0).count() <= 16);
    assert!(reasons(&even).iter().any(|(_, reason)| *reason == UnshadowedReason::AtlasFull), "reported");
}

#[test]
fn row_38_a_light_that_matters_more_has_larger_tiles() {
    let lights = [spot_at(-2.0), spot_at(0.0), spot_at(2.0)];
    let width = |importance| {
        let own = LightShadows { importance, ..LightShadows::new(1.into()) };
        let settings = ShadowSettings { lights: vec![own], ..ShadowSettings::default() };
        let casters = Boxes(vec![cube(DVec3::ZERO, 1.0)]);
        let plan = try_plan(&default_camera(), &lights, &casters, &settings).unwrap();
        plan.atlas.unwrap().tiles.iter().find(|tile| tile.light == 1).unwrap().rect.width
    };
    assert!(
        width(0.1) < width(1.0) && width(1.0) <= width(8.0),
        "{} {} {}",
        width(0.1),
        width(1.0),
        width(8.0)
    );
}

#[test]
fn row_38_tiles_keep_size_and_place_from_frame_to_frame() {
    let (lights, casters) = street_lights(24);
    let settings = ShadowSettings::default();
    let at = |step: f64| camera(DVec3::new(0.3 * step, 2.0, 8.0), DVec3::ZERO);
    let plan = |step: f64, previous: Option<&shadowgraph_shadows::PlanState>| {
        let camera = at(step);
        let inputs = ShadowInputs {
            view: 0,
            camera: &camera,
            aspect: 1.5,
            lights: &lights,
            casters: &casters,
            origin_world: DVec3::ZERO,
            settings: &settings,
        };
        plan_shadows_after(&inputs, previous, &Requirements::NONE).unwrap()
    };
    let rects = |plan: &ShadowPlan| plan.state.atlas_allocation.rects.clone();
    let (mut changed, mut changed_without) = (0, 0);
    let first = plan(0.0, None);
    let mut previous = first.clone();
    for step in 1..40 {
        // Back and forth, by 30 cm each.
        let at = f64::from(step % 2);
        let next = plan(at, Some(&previous.state));
        changed += usize::from(rects(&next) != rects(&previous));
        changed_without += usize::from(rects(&plan(at, None)) != rects(&plan(1.0 - at, None)));
        previous = next;
    }
    assert!(changed <= 1, "{changed} of 39, {changed_without} without a previous frame");
}

#[test]
fn casters_outside_the_view_are_drawn_within_the_techniques_blocker_reach() {
    // The second box is outside the view, and its shadow too.
    let casters = Boxes(vec![cube(DVec3::ZERO, 1.0), cube(DVec3::new(9.0, 0.0, 3.0), 1.0)]);
    let settings = ShadowSettings { distance_m: 20.0, ..ShadowSettings::default() };
    let camera = default_camera();
    let inputs = ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 1.5,
        lights: &[sun(DVec3::NEG_Y, 1.0)],
        casters: &casters,
        origin_world: origin_near(camera.position_world()),
        settings: &settings,
    };
    let drawn = |blocker_reach_m| {
        let requirements = Requirements { blocker_reach_m, ..Requirements::NONE };
        let plan = plan_shadows_after(&inputs, None, &requirements).unwrap();
        plan.cascades.unwrap().tiles.iter().any(|tile| tile.casters.contains(&1))
    };
    assert!(!drawn(0.0) && drawn(10.0));
}
