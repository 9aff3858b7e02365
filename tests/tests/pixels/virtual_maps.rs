//! The limits of `virtual`: many lights, small pools, and devices with the default limits of WebGPU.

use crate::stage::gpu;
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Light, LightKind, Projection, Scene};
use shadowgraph::shadows::{PCF, PcssSettings, ShadowSettings, TechniqueKind, VIRTUAL, VirtualSettings};
use shadowgraph::{Gpu, Pipeline, RenderConfig, RenderedFrame, Renderer, ViewOptions, wgpu};
use shadowgraph_quality::{Comparator, built_in_cases};
use shadowgraph_samples::city::city;
use shadowgraph_samples::demo::demo_scene;
use shadowgraph_samples::test_scenes::test_scene;

fn config(technique: TechniqueKind) -> RenderConfig {
    RenderConfig { technique: Some(technique.into()), ..Pipeline::minimal_lit().into() }
}

fn with_pool(pool_mib: u32) -> ShadowSettings {
    let mut shadows = ShadowSettings::default();
    shadows.techniques.set(&VirtualSettings { pool_mib, ..VirtualSettings::default() }).unwrap();
    shadows
}

/// Returns the sun of a city and the 64 nearest street lights in front of a camera; all cast shadows.
fn lights_in_view(scene: &Scene, camera: &Camera) -> Vec<Light> {
    let ahead = camera.forward_world();
    let distance_m = |light: &Light| {
        let LightKind::Spot { position_world, .. } = light.kind else { return None };
        let offset = position_world - camera.position_world();
        (offset.dot(ahead) > 0.9 * offset.length()).then(|| offset.length())
    };
    let mut street: Vec<_> =
        scene.lights().iter().filter_map(|light| Some((distance_m(light)?, light.clone()))).collect();
    street.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let street = street.into_iter().take(64).map(|(_, light)| Light { casts_shadow: true, ..light });
    scene.lights().iter().take(1).cloned().chain(street).collect()
}

/// Returns by how many levels the maps of a frame are coarser than pixels ask for.
fn coarser_levels(frame: &RenderedFrame) -> f64 {
    let counts = &frame.counts.shadows;
    let (_, quarters) = counts.iter().find(|(name, _)| name.starts_with("coarsening")).unwrap();
    f64::from(*quarters) / 4.0
}

#[test]
fn each_of_64_lights_in_a_city_has_texels_of_at_most_twice_its_pixels() {
    let Some(gpu) = gpu() else { return };
    let mut scene = city(30_000, 1).unwrap();
    // In a street, at eye height.
    let camera = &scene.cameras[0].clone();
    let lights = lights_in_view(&scene, camera);
    assert_eq!(lights.len(), 65);
    scene.set_lights(lights);
    let draw = |pool_mib| {
        let mut renderer =
            Renderer::with_config(gpu, scene.clone(), camera, Aov::Visibility(0), config(VIRTUAL)).unwrap();
        let shadows = ShadowSettings { distance_m: 1000.0, ..with_pool(pool_mib) };
        let options = ViewOptions { camera: camera.clone(), size_px: [1280, 720], shadows };
        let frame = renderer.draw(gpu, &options).unwrap();
        println!("{pool_mib} MiB: {:?}", frame.counts.shadows);
        assert!(frame.unshadowed.is_empty(), "{:?}", frame.unshadowed);
        frame
    };
    let (large, small) = (draw(64), draw(16));
    let texels_per_pixel = (f64::from(VirtualSettings::default().level_bias) + coarser_levels(&large)).exp2();
    assert!(texels_per_pixel <= 2.0, "{:?}", large.counts);
    assert!(coarser_levels(&small) > coarser_levels(&large));
    let said = small.counts.shadow_warning.unwrap();
    assert!(said.contains("pool_mib"), "{said}");
}

#[test]
fn sizes_of_the_pool_that_are_out_of_range_are_refused() {
    for pool_mib in [0, 1, 2, 48, 2048] {
        let own = VirtualSettings { pool_mib, ..VirtualSettings::default() };
        let said = ShadowSettings::default().techniques.set(&own).unwrap_err().to_string();
        assert!(said.contains("pool_mib") && said.contains("4, 8, 16"), "{said}");
    }
}

/// Returns the percentage of the contacts of slats that are lit, with lights of these radii and a small pool.
fn missing_contacts(gpu: &Gpu, light: Light, [sun_radius_rad, light_radius_m]: [f32; 2]) -> f64 {
    let cases = built_in_cases().unwrap().cases;
    let case = cases.iter().find(|case| case.name() == "slats").unwrap();
    let mut scene = test_scene("slats").unwrap();
    scene.insert_light(light);
    let mut shadows = with_pool(8);
    let radii = PcssSettings { sun_radius_rad, light_radius_m, ..PcssSettings::default() };
    shadows.techniques.set(&radii).unwrap();
    let options = ViewOptions { camera: case.views[0].camera(), size_px: [640, 360], shadows };
    let aov = Aov::Visibility(0);
    let mut renderer = Renderer::with_config(gpu, scene, &options.camera, aov, config(VIRTUAL)).unwrap();
    let mut comparator = Comparator::new(gpu, &renderer, 0).unwrap();
    let contacts = comparator.measure(&mut renderer, &options).unwrap().errors.missing_contacts;
    assert!(contacts.contacts > 1000, "{contacts:?}");
    contacts.missing_percent
}

#[test]
fn thin_casters_keep_the_contacts_that_a_wide_filter_would_light() {
    let Some(gpu) = gpu() else { return };
    let cases = built_in_cases().unwrap().cases;
    let case = cases.iter().find(|case| case.name() == "slats").unwrap();
    let kind = LightKind::Spot {
        position_world: DVec3::new(3.0, 6.0, -5.0),
        direction: DVec3::new(-3.0, -6.0, 5.0).normalize(),
        range: Some(30.0),
        inner_angle: 0.6,
        outer_angle: 0.7,
    };
    for light in [case.sun(30.0), Light { kind, ..case.sun(30.0) }] {
        let kind = light.kind;
        // Penumbrae of the largest lights are as wide as the filter everywhere.
        let wide = missing_contacts(gpu, light.clone(), [0.2, 10.0]);
        let missing = missing_contacts(gpu, light, [0.004_65, 0.05]);
        println!(
            "{kind:?}: {missing:.2} % of the contacts are lit, with filters of constant width {wide:.2} %"
        );
        assert!(missing < 0.9 * wide, "{kind:?}: {missing} and {wide} %");
    }
}

/// Opens a device with the default limits of WebGPU, and no features.
fn default_gpu(like: &Gpu) -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
    let adapter = adapters.into_iter().find(|adapter| adapter.get_info() == like.adapter).unwrap();
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).unwrap();
    Gpu { device, queue, adapter: adapter.get_info() }
}

#[test]
fn a_device_with_the_default_limits_draws_the_same_image_and_refuses_larger_pools() {
    let Some(gpu) = gpu() else { return };
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let draw = |gpu: &Gpu| {
        let config = config(VIRTUAL);
        let mut renderer = Renderer::with_config(gpu, scene.clone(), &camera, Aov::Color, config).unwrap();
        let options = ViewOptions { camera: camera.clone(), size_px: [192, 108], shadows: with_pool(64) };
        (0..2).map(|_| renderer.draw(gpu, &options).unwrap().image.rgba8).collect::<Vec<_>>()
    };
    let smaller = &default_gpu(gpu);
    assert!(draw(gpu) == draw(smaller));

    // Storage buffers have at most 128 MiB there.
    let mut renderer =
        Renderer::with_config(smaller, scene.clone(), &camera, Aov::Color, config(VIRTUAL)).unwrap();
    let options = ViewOptions { camera: camera.clone(), size_px: [64, 36], shadows: with_pool(256) };
    let said = renderer.draw(smaller, &options).err().map(|error| error.to_string()).unwrap();
    assert!(said.contains("pool_mib") && said.contains("from 4 to 64 MiB on this device"), "{said}");
}

#[test]
fn the_smallest_pool_gives_coarse_shadows_without_holes() {
    let Some(gpu) = gpu() else { return };
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let draw = |technique, shadows| {
        let config = config(technique);
        let mut renderer =
            Renderer::with_config(gpu, scene.clone(), &camera, Aov::Visibility(0), config).unwrap();
        renderer.draw(gpu, &ViewOptions { camera: camera.clone(), size_px: [320, 180], shadows }).unwrap()
    };
    let small = draw(VIRTUAL, with_pool(4));
    assert!(coarser_levels(&small) > 0.0);
    let other = draw(PCF, ShadowSettings::default());
    let pixels = small.image.rgba8.chunks_exact(4).zip(other.image.rgba8.chunks_exact(4));
    let wrong = pixels.filter(|(a, b)| a[0].abs_diff(b[0]) > 128).count();
    // Narrow shadows are lost; those of towers and arches are not.
    assert!(wrong * 50 < 320 * 180, "{wrong} pixels");
}

#[test]
fn a_near_plane_at_a_tenth_of_a_millimetre_leaves_the_shadows_nine_hundred_metres_away() {
    let Some(gpu) = gpu() else { return };
    let scene = city(30_000, 1).unwrap();
    let draw = |near| {
        let projection = Projection::Perspective { fov_y: 1.0, near, far: None };
        let camera = Camera { projection, ..scene.cameras[0].clone() };
        let mut renderer =
            Renderer::with_config(gpu, scene.clone(), &camera, Aov::Visibility(0), config(VIRTUAL)).unwrap();
        let shadows = ShadowSettings { distance_m: 900.0, ..with_pool(64) };
        let frame = renderer.draw(gpu, &ViewOptions { camera, size_px: [320, 180], shadows }).unwrap();
        assert!(!frame.unshadowed.iter().any(|unshadowed| unshadowed.light == 0), "{:?}", frame.unshadowed);
        frame.image.rgba8
    };
    let (far, near) = (draw(0.1), draw(1e-4));
    let pixels = near.chunks_exact(4).zip(far.chunks_exact(4));
    let differing = pixels.filter(|(a, b)| a[0].abs_diff(b[0]) > 64).count();
    assert!(differing * 200 < 320 * 180, "{differing} pixels");
}
