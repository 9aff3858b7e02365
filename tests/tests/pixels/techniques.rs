//! Properties that techniques share, and the strength of each.

use crate::stage::{
    add_instance, add_mesh, box_mesh, camera, cube_on_floor, gpu, hard, only_material, sun, sun_direction,
    view,
};
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::Scene;
use shadowgraph::shadows::{
    ContactSettings, EVSM, EvsmMoments, EvsmPrecision, EvsmSettings, MSM, PCF, PCSS, RAYTRACED,
    RaytracedSettings, SDSM, SplitScheme, Technique, TechniqueKind,
};
use shadowgraph::{Gpu, RenderConfig, Renderer, ViewOptions};
use shadowgraph_samples::demo::demo_scene;

/// Returns the visibility of light 0 in each pixel; `None` in the background and where the surface faces away.
fn greys(
    gpu: &Gpu,
    scene: &Scene,
    options: &ViewOptions,
    config: impl Into<RenderConfig>,
) -> Vec<Option<u8>> {
    let mut renderer =
        Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Visibility(0), config).unwrap();
    let image = renderer.draw(gpu, options).unwrap().image;
    image.rgba8.chunks_exact(4).map(|rgba| (rgba[3] == 255).then_some(rgba[0])).collect()
}

fn truth(gpu: &Gpu, scene: &Scene, options: &ViewOptions) -> Vec<Option<u8>> {
    greys(gpu, scene, &hard(options), RAYTRACED)
}

/// Returns the fraction of the pixels in which two images differ by more than `by`.
fn differing(a: &[Option<u8>], b: &[Option<u8>], by: u8) -> f64 {
    let pairs: Vec<_> = a.iter().zip(b).filter_map(|(a, b)| a.zip(*b)).collect();
    assert!(pairs.len() > a.len() / 4, "{}", pairs.len());
    pairs.iter().filter(|(a, b)| a.abs_diff(*b) > by).count() as f64 / pairs.len() as f64
}

/// Returns the courtyard of the demo scene with small maps.
fn demo() -> (Scene, ViewOptions) {
    let mut options = view(camera(DVec3::new(-4.8, 4.2, 15.0), DVec3::new(-5.3, 0.2, 9.4)), 60.0);
    options.shadows.cascades.map_size_px = 1024;
    options.shadows.atlas.map_size_px = 512;
    (demo_scene(), options)
}

#[test]
fn screen_space_shadows_match_per_pixel_shadows_with_every_map_technique() {
    let Some(gpu) = gpu() else { return };
    let (scene, options) = demo();
    for kind in [PCF, PCSS, EVSM, MSM, SDSM] {
        let per_pixel = greys(gpu, &scene, &options, kind);
        let screen_space = greys(gpu, &scene, &options, Technique::from(kind).with_screen());
        let part = differing(&per_pixel, &screen_space, 2);
        println!("{}: {:.3} % of the pixels differ", kind.name, 100.0 * part);
        assert!(part < 0.001, "{}: {part}", kind.name);
        assert!(per_pixel.iter().flatten().any(|grey| *grey < 3), "{}", kind.name);
    }
}

/// Counts the pixels that are dark among lit ones or lit among dark ones, where neither they nor their eight neighbours are so in
/// the reference.
fn specks(greys: &[Option<u8>], truth: &[Option<u8>], width: usize) -> usize {
    let around = |pixel: usize| {
        [-1, 0, 1].into_iter().flat_map(move |y: isize| {
            [-1, 0, 1].into_iter().map(move |x: isize| pixel as isize + y * width as isize + x)
        })
    };
    let is_speck = |&pixel: &usize| {
        let Some(grey) = greys[pixel] else { return false };
        let mut neighbours = around(pixel).map(|at| truth.get(at as usize).copied().flatten());
        match grey {
            0..64 => neighbours.all(|grey| grey == Some(255)),
            192.. => neighbours.all(|grey| grey == Some(0)),
            _ => false,
        }
    };
    (0..greys.len()).filter(is_speck).count()
}

#[test]
fn moment_maps_have_no_dark_or_bright_specks_in_any_format() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    // Two layers of occluders: light leaks where their shadows overlap.
    let plate = box_mesh(DVec3::new(-2.0, 1.6, -0.2), DVec3::new(2.0, 1.7, 0.2));
    add_mesh(&mut scene, plate, DVec3::ZERO);
    scene.insert_light(sun(sun_direction(40.0, 130.0)));
    let mut options = view(camera(DVec3::new(2.0, 3.0, 4.0), DVec3::new(0.0, 0.3, 0.0)), 20.0);
    options.shadows.cascades.map_size_px = 2048;
    let truth = truth(gpu, &scene, &options);
    let check = |name: &str, kind: TechniqueKind, options: &ViewOptions| {
        let greys = greys(gpu, &scene, options, kind);
        let (specks, wrong) =
            (specks(&greys, &truth, options.size_px[0] as usize), differing(&greys, &truth, 127));
        println!("{name}: {specks} specks, {:.2} % wrong", 100.0 * wrong);
        assert!(specks == 0 && wrong < 0.01, "{name}: {specks} {wrong}");
    };
    for (moments, precision) in [
        (EvsmMoments::Two, EvsmPrecision::Half),
        (EvsmMoments::Two, EvsmPrecision::Full),
        (EvsmMoments::Four, EvsmPrecision::Half),
        (EvsmMoments::Four, EvsmPrecision::Full),
    ] {
        let exponents = if precision == EvsmPrecision::Half { [5.54, 5.54] } else { [40.0, 5.0] };
        let own = EvsmSettings {
            moments,
            precision,
            positive_exponent: exponents[0],
            negative_exponent: exponents[1],
            ..EvsmSettings::default()
        };
        options.shadows.techniques.set(&own).unwrap();
        check(&format!("evsm {moments:?} {precision:?}"), EVSM, &options);
    }
    check("msm", MSM, &options);
}

#[test]
fn contact_shadows_add_shadows_that_maps_are_too_coarse_for() {
    let Some(gpu) = gpu() else { return };
    // Pebbles of 3 cm with texels of 10 cm.
    let mut scene = cube_on_floor(DVec3::new(0.0, 0.0, -3.0));
    let pebble = scene.insert_mesh(box_mesh(DVec3::new(-0.03, 0.0, -0.03), DVec3::new(0.03, 0.06, 0.03)));
    let material = only_material(&scene);
    for i in 0..25 {
        let at = DVec3::new(f64::from(i % 5) * 0.2 - 0.4, 0.0, f64::from(i / 5) * 0.2 - 0.4);
        add_instance(&mut scene, pebble, material, at);
    }
    scene.insert_light(sun(sun_direction(40.0, 100.0)));
    let mut options = view(camera(DVec3::new(0.2, 0.7, 1.2), DVec3::ZERO), 20.0);
    options.shadows.cascades.map_size_px = 256;
    options.shadows.cascades.count = 1;
    let truth = truth(gpu, &scene, &options);
    let alone = differing(&greys(gpu, &scene, &options, PCF), &truth, 127);
    let with = differing(&greys(gpu, &scene, &options, Technique::from(PCF).with_contact()), &truth, 127);
    println!("wrong without {alone:.4}, with contact shadows {with:.4}");
    assert!(with < 0.7 * alone, "{with} {alone}");
    // Such a short march finds no occluder.
    let short = ContactSettings { length_texels: 0.1, ..ContactSettings::default() };
    options.shadows.techniques.set(&short).unwrap();
    let short = differing(&greys(gpu, &scene, &options, Technique::from(PCF).with_contact()), &truth, 127);
    assert!((short - alone).abs() < 0.1 * alone, "{short} {alone}");
}

#[test]
fn cascades_fitted_to_the_visible_depths_have_finer_texels() {
    let Some(gpu) = gpu() else { return };
    let (scene, mut options) = demo();
    // All visible surfaces are at about the same distance.
    options.camera = camera(DVec3::new(-4.0, 16.0, 22.0), DVec3::new(-4.0, 0.0, 8.0));
    options.shadows.cascades.map_size_px = 512;
    // Others begin where surfaces are visible too.
    options.shadows.cascades.split = SplitScheme::Standard;
    let truth = truth(gpu, &scene, &options);
    let [fixed, fitted] = [PCF, SDSM].map(|kind| differing(&greys(gpu, &scene, &options, kind), &truth, 127));
    println!("wrong with fixed splits {fixed:.4}, fitted {fitted:.4}");
    assert!(fitted < 0.9 * fixed, "{fitted} {fixed}");
    // One cascade covers the whole view; there is nothing to fit.
    options.shadows.cascades.count = 1;
    let [fixed, fitted] = [PCF, SDSM].map(|kind| greys(gpu, &scene, &options, kind));
    assert!(differing(&fixed, &fitted, 2) < 0.02);
}

#[test]
fn fitted_cascades_have_every_caster_that_the_view_needs() {
    let Some(gpu) = gpu() else { return };
    let (scene, mut options) = demo();
    options.camera = camera(DVec3::new(8.0, 4.0, 16.0), DVec3::new(0.0, 1.0, 0.0));
    let truth = truth(gpu, &scene, &options);
    let fitted = greys(gpu, &scene, &options, SDSM);
    assert!(differing(&fitted, &truth, 127) < 0.02, "{}", differing(&fitted, &truth, 127));
}

#[test]
fn the_denoiser_removes_noise_from_penumbrae_and_keeps_hard_edges() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    let plate = box_mesh(DVec3::new(-1.5, 1.6, -1.0), DVec3::new(1.5, 1.7, 1.0));
    add_mesh(&mut scene, plate, DVec3::ZERO);
    scene.insert_light(sun(sun_direction(50.0, 130.0)));
    let mut options = view(camera(DVec3::new(2.0, 3.0, 4.0), DVec3::new(0.0, 0.3, 0.0)), 20.0);
    let mut draw = |rays, denoise_px| {
        let own = RaytracedSettings { rays, denoise_px, sun_radius_rad: 0.1, ..RaytracedSettings::default() };
        options.shadows.techniques.set(&own).unwrap();
        greys(gpu, &scene, &options, RAYTRACED)
    };
    let (fine, grainy, smooth) = (draw(64, 0), draw(4, 0), draw(4, 2));
    let off = |greys: &[Option<u8>]| {
        let pairs = greys.iter().zip(&fine).filter_map(|(a, b)| a.zip(*b));
        pairs.map(|(a, b)| f64::from(a.abs_diff(b))).sum::<f64>()
    };
    println!("off by {} with grain, {} without", off(&grainy), off(&smooth));
    assert!(off(&smooth) < 0.85 * off(&grainy), "{} {}", off(&smooth), off(&grainy));
    // Pixels all of whose rays agree stay as they are.
    let agree = grainy.iter().zip(&smooth).filter(|(grey, _)| matches!(grey, Some(0 | 255)));
    assert!(agree.into_iter().all(|(a, b)| a == b));
}
