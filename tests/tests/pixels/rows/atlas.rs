//! Spot lights and the atlas.

use super::{count, cube_under_spot, cube_view, dark_and_between, different, greys, plan, spot, wrong};
use crate::stage::{SIZE_PX, add_cube, add_mesh, box_mesh, cube_on_floor, gpu, sun, sun_direction, view};
use glam::{DVec3, Vec3};
use shadowgraph::options::Aov;
use shadowgraph::scene::gpu::{DepthTarget, GpuScene};
use shadowgraph::shadows::{DepthFormat, LightShadows, PCF, Pcf, ShadowFilter};
use shadowgraph::{Renderer, SceneCasters};

#[test]
fn row_02_casters_in_front_of_the_near_plane_are_kept() {
    let Some(gpu) = gpu() else { return };
    let scene = cube_under_spot();
    // The near plane is behind the cube.
    let options = cube_view(|settings| settings.atlas.spot_near_m = 5.4);
    let drawn = [true, false].map(|clamp_near| {
        let upload = GpuScene::new(&gpu.device, &gpu.queue, &scene, DVec3::ZERO).unwrap();
        let target = DepthTarget { clamp_near, ..DepthTarget::default() };
        let casters = SceneCasters::with_target(&gpu.device, upload, &target).unwrap();
        let map = crate::maps::draw_map(
            gpu,
            &Pcf::new(&gpu.device),
            &casters,
            scene.lights(),
            &options.camera,
            &options.shadows,
            "atlas",
        );
        map.depth.iter().filter(|depth| **depth == 1.0).count()
    });
    assert!(drawn[0] > 10_000 && drawn[1] == 0, "{drawn:?}");
}

#[test]
fn row_04_maps_have_any_allowed_size_and_depth_format() {
    let Some(gpu) = gpu() else { return };
    let scene = cube_under_spot();
    let wrong = |map_size_px, depth| {
        let options = cube_view(|settings| {
            settings.atlas.map_size_px = map_size_px;
            settings.atlas.depth = depth;
            settings.atlas.spot_near_m = 1.0;
        });
        wrong(gpu, &scene, 0, &options)
    };
    let pixels = (SIZE_PX[0] * SIZE_PX[1]) as usize;
    for depth in DepthFormat::ALL {
        let (coarse, fine) = (wrong(256, depth), wrong(2048, depth));
        assert!(fine < coarse && fine < pixels / 400, "{depth:?}: {coarse} {fine}");
    }
    assert!(wrong(8192, DepthFormat::Depth16) < pixels / 400);
    let mut refused = cube_view(|settings| settings.atlas.map_size_px = 128).shadows;
    assert!(refused.validate().is_err());
    refused.atlas.map_size_px = 16384;
    assert!(refused.validate().is_err());
}

#[test]
fn row_05_each_light_has_its_own_strength_filter_and_biases() {
    let Some(gpu) = gpu() else { return };
    let scene = cube_under_spot();
    // Coarse enough that the bias of a texel is visible.
    let coarse = |lights| {
        cube_view(|settings| {
            settings.lights = lights;
            settings.atlas.map_size_px = 256;
        })
    };
    let with = |own: LightShadows| greys(gpu, &scene, 0, &coarse(vec![own]));
    let plain = LightShadows::new(0.into());
    let usual = with(plain.clone());
    assert_eq!(usual, greys(gpu, &scene, 0, &coarse(vec![])), "settings that change nothing");
    let half = with(LightShadows { strength: 0.5, ..plain.clone() });
    assert!(count(&usual, |grey| grey == 255).abs_diff(count(&half, |grey| grey == 255)) < 50);
    assert!(count(&half, |grey| (126..=129).contains(&grey)) >= count(&usual, |grey| grey == 0));
    assert_eq!(count(&half, |grey| grey < 126), 0);
    let hard = with(LightShadows { filter: Some(ShadowFilter::Tent2), ..plain.clone() });
    assert!(dark_and_between(&hard).1 * 2 < dark_and_between(&usual).1);
    // A constant bias of 16 texels towards the light detaches the shadow.
    let moved = with(LightShadows { depth_texels: Some(16.0), ..plain.clone() });
    let gone = different(&moved, &usual, 60);
    assert!(gone > 10, "{gone}");
    // Without bias the lit floor shadows itself.
    let own =
        LightShadows { depth_texels: Some(0.0), slope: Some(0.0), normal_texels: Some(0.0), ..plain.clone() };
    let mut options = coarse(vec![own]);
    options.shadows.bias.min_slope = 0.0;
    let acne = greys(gpu, &scene, 0, &options);
    assert!(count(&acne, |grey| grey < 200) > 2 * count(&usual, |grey| grey < 200));
    // A separate near plane.
    let near =
        plan(&scene, &cube_view(|s| s.lights = vec![LightShadows { near_m: Some(1.5), ..plain.clone() }]));
    assert_eq!((near.views[0].near_m, plan(&scene, &cube_view(|_| ())).views[0].near_m), (1.5, 0.05));
    let none = LightShadows { casts: false, ..plain };
    assert!(plan(&scene, &cube_view(|settings| settings.lights = vec![none])).atlas.is_none());
}

#[test]
fn row_05_settings_can_name_a_light_and_an_unknown_name_is_an_error() {
    let mut scene = cube_under_spot();
    let named = shadowgraph::scene::Light { name: Some("ceiling".into()), ..scene.lights()[0].clone() };
    scene.replace_light(scene.light_keys()[0], named).unwrap();
    let own = |name: &str| LightShadows { strength: 0.25, ..LightShadows::new(name.into()) };
    let options = cube_view(|settings| settings.lights = vec![own("ceiling")]);
    assert_eq!(plan(&scene, &options).lights[0].strength, 0.25);
    let wrong = cube_view(|settings| settings.lights = vec![own("cieling")]);
    let renderer =
        Renderer::new(&shadowgraph::Gpu::noop().unwrap(), scene, &wrong.camera, Aov::Color).unwrap();
    let error = renderer.plan(&wrong).unwrap_err().to_string();
    assert!(error.contains("\"cieling\"") && error.contains(": 1, numbered from 0"), "{error}");
}

#[test]
fn row_08_nothing_is_read_from_a_neighbouring_tile() {
    let Some(gpu) = gpu() else { return };
    let alone = {
        let mut scene = cube_under_spot();
        scene.insert_light(spot(DVec3::new(3.0, 3.5, 1.0), DVec3::ZERO, 0.6));
        scene
    };
    // Fills the second light's tile up to its edges, and is behind the first light.
    let mut crowded = alone.clone();
    let shell = box_mesh(DVec3::new(-0.5, -0.5, -0.5), DVec3::new(0.5, 0.5, 0.5));
    add_mesh(&mut crowded, shell, DVec3::new(3.0, 3.5, 1.0));
    for filter in ShadowFilter::ALL {
        let options = cube_view(|settings| settings.atlas.filter = filter);
        assert_eq!(plan(&crowded, &options).views[1].tile_px[0], 1024, "side by side");
        let (with, without) = (greys(gpu, &crowded, 0, &options), greys(gpu, &alone, 0, &options));
        // The box itself is visible in one of them.
        let same = with.iter().zip(&without).filter(|(a, b)| a == b).count();
        assert!(same > with.len() * 9 / 10);
        let second = greys(gpu, &crowded, 1, &options);
        assert_eq!(count(&second, |grey| grey > 0 && grey < 255), 0, "{filter:?}: all of it is dark");
    }
}

#[test]
fn row_09_several_directional_lights_cast_shadows_next_to_spot_lights() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    for (azimuth, intensity) in [(0.0, 500.0), (120.0, 2000.0), (240.0, 1000.0)] {
        let light = sun(sun_direction(45.0, azimuth));
        scene.insert_light(shadowgraph::scene::Light { intensity, color: Vec3::ONE, ..light });
    }
    scene.insert_light(spot(DVec3::new(-3.0, 3.5, 1.0), DVec3::ZERO, 0.6));
    let options = cube_view(|_| ());
    let planned = plan(&scene, &options);
    assert!(planned.cascades.as_ref().unwrap().tiles.iter().all(|tile| tile.light == 1), "the brightest");
    assert_eq!(planned.atlas.as_ref().unwrap().tiles.len(), 3);
    for light in 0..4 {
        let wrong = wrong(gpu, &scene, light, &options);
        assert!(wrong < 400, "light {light}: {wrong} pixels");
        assert!(count(&greys(gpu, &scene, light, &options), |grey| grey < 255) > 100, "light {light}");
    }
}

#[test]
fn row_10_the_shadow_distance_applies_to_every_kind_of_light() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_under_spot();
    scene.insert_light(sun(sun_direction(40.0, 250.0)));
    for light in 0..2 {
        // The cube is 5 m away.
        let dark = [3.0, 20.0].map(|distance_m| {
            count(&greys(gpu, &scene, light, &view(super::at_cube(), distance_m)), |grey| grey < 255)
        });
        assert!(dark[0] == 0 && dark[1] > 500, "{dark:?}");
    }
}

#[test]
fn row_17_without_shadows_maps_are_one_texel() {
    let scene = cube_on_floor(DVec3::ZERO);
    let options = cube_view(|_| ());
    let with_sun = {
        let mut scene = scene.clone();
        scene.insert_light(sun(DVec3::NEG_Y));
        scene
    };
    let largest = [scene, with_sun].map(|scene| {
        let renderer = Renderer::with_config(
            &shadowgraph::Gpu::noop().unwrap(),
            scene,
            &options.camera,
            Aov::Color,
            PCF,
        )
        .unwrap();
        let (plan, _) = renderer.plan(&options).unwrap();
        let text = plan.to_text();
        (text.contains("no cascades"), text.contains("4096x4096"))
    });
    assert_eq!(largest, [(true, false), (false, true)]);
}

#[test]
fn row_11_casters_of_one_light_render_only_into_its_tile() {
    let Some(gpu) = gpu() else { return };
    let map = |wall: bool| {
        let mut scene = cube_under_spot();
        scene.insert_light(spot(DVec3::new(0.0, 3.5, 30.0), DVec3::new(0.0, 0.0, 28.0), 0.4));
        add_cube(&mut scene, DVec3::new(0.0, 0.0, 28.0));
        if wall {
            // Directly in front of the first light, and far beyond the edges of its tile.
            let wall = box_mesh(DVec3::new(-9.0, -9.0, -9.0), DVec3::new(9.0, -8.9, 9.0));
            add_mesh(&mut scene, wall, DVec3::new(-3.0, 11.9, 1.0));
        }
        let upload = GpuScene::new(&gpu.device, &gpu.queue, &scene, DVec3::ZERO).unwrap();
        let casters = SceneCasters::new(&gpu.device, upload).unwrap();
        let mut options =
            view(crate::stage::camera(DVec3::new(8.0, 9.0, 40.0), DVec3::new(0.0, 0.0, 10.0)), 90.0);
        options.shadows.atlas.map_size_px = 512;
        options.shadows.atlas.tiles = shadowgraph::shadows::AtlasTiles::Even;
        let technique = Pcf::new(&gpu.device);
        crate::maps::draw_map(
            gpu,
            &technique,
            &casters,
            scene.lights(),
            &options.camera,
            &options.shadows,
            "atlas",
        )
    };
    let (with, without) = (map(true), map(false));
    assert_eq!((with.size_px, without.size_px), ([512, 256], [512, 256]), "two tiles, side by side");
    let (mut first, mut second) = (0, 0);
    for (x, y) in (0..256).flat_map(|y| (0..512).map(move |x| (x, y))) {
        let changed = usize::from(with.depth_at(x, y) != without.depth_at(x, y));
        if x < 256 { first += changed } else { second += changed }
    }
    assert!(first > 50_000 && second == 0, "{first} {second}");
}
