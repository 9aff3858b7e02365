//! `pcss`, and `virtual` with penumbrae: they are as wide as the size of the light gives.

use crate::stage::{add_mesh, box_mesh, camera, floor_mesh, gpu, light, material, sun, view};
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Light, LightKind, Scene};
use shadowgraph::shadows::{PCSS, PcssSettings, TechniqueKind, VIRTUAL, VirtualSettings};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_quality::Comparator;

/// Returns a plate above a floor, its edge above x = 0, under a light.
fn plate(height_m: f64, light: Light) -> Scene {
    let plate = box_mesh(DVec3::new(0.0, height_m, -3.0), DVec3::new(6.0, height_m + 0.02, 3.0));
    let mut scene = Scene::default();
    scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(10.0), DVec3::ZERO);
    add_mesh(&mut scene, plate, DVec3::ZERO);
    scene.insert_light(light);
    scene
}

/// Returns a view of the floor below the edge.
fn options() -> ViewOptions {
    let mut options = view(camera(DVec3::new(-0.5, 0.4, 0.0), DVec3::ZERO), 20.0);
    // Texels of millimetres: the widest penumbrae are twenty texels wide.
    options.shadows.cascades.map_size_px = 1024;
    options.shadows.atlas.map_size_px = 1024;
    let soft = VirtualSettings { penumbrae: true, ..VirtualSettings::default() };
    options.shadows.techniques.set(&soft).unwrap();
    options
}

/// Returns settings with many taps, so that noise is small.
fn fine() -> PcssSettings {
    PcssSettings { filter_taps: 64, blocker_taps: 64, max_radius_texels: 24.0, ..PcssSettings::default() }
}

/// Returns the width of the penumbra on the floor, from a tenth to nine tenths of the light, metres.
fn width_m(gpu: &Gpu, scene: &Scene, options: &ViewOptions, technique: TechniqueKind) -> f64 {
    let aov = Aov::Visibility(0);
    let mut renderer = Renderer::with_config(gpu, scene.clone(), &options.camera, aov, technique).unwrap();
    let reference = Comparator::new(gpu, &renderer, 0).unwrap().reference(&mut renderer, options, 0).unwrap();
    let image = renderer.draw(gpu, options).unwrap().image;
    let pixels = reference.surfaces.positions.iter().zip(image.rgba8.chunks_exact(4));
    let between = pixels.filter(|(_, rgba)| rgba[3] == 255 && (26..=229).contains(&rgba[0]));
    let mut between: Vec<f32> = between.map(|(position, _)| position.x).collect();
    between.sort_by(f32::total_cmp);
    assert!(between.len() > 100, "{}", between.len());
    // Noise moves some pixels beyond both ends.
    let at = |part: usize| f64::from(between[between.len() * part / 100]);
    at(98) - at(2)
}

#[test]
fn penumbrae_of_a_sun_are_as_wide_as_its_angular_size_gives() {
    let Some(gpu) = gpu() else { return };
    let mut options = options();
    options.shadows.techniques.set(&PcssSettings { sun_radius_rad: 0.05, ..fine() }).unwrap();
    for height_m in [0.5, 1.0, 1.5] {
        // The middle eight tenths of the light of a disc behind a straight edge cover 0.687 of the penumbra.
        let right = 2.0 * height_m * 0.05f64.tan() * 0.687;
        for technique in [PCSS, VIRTUAL] {
            let width = width_m(gpu, &plate(height_m, sun(DVec3::NEG_Y)), &options, technique);
            let name = technique.name;
            assert!((width / right - 1.0).abs() < 0.25, "{name}, {height_m} m: {width} instead of {right}");
            println!("{name}, {height_m} m: {width} m wide, {right} m expected");
        }
    }
}

#[test]
fn penumbrae_of_a_spot_light_widen_with_the_distance_behind_the_occluder() {
    let Some(gpu) = gpu() else { return };
    let mut options = options();
    options.shadows.techniques.set(&PcssSettings { light_radius_m: 0.1, ..fine() }).unwrap();
    let spot = || {
        let kind = LightKind::Spot {
            position_world: DVec3::new(0.0, 4.0, 0.0),
            direction: DVec3::NEG_Y,
            range: Some(10.0),
            inner_angle: 0.4,
            outer_angle: 0.5,
        };
        light(kind, 2000.0)
    };
    for height_m in [1.0, 1.8] {
        let right = 2.0 * 0.1 * height_m / (4.0 - height_m) * 0.687;
        for technique in [PCSS, VIRTUAL] {
            let width = width_m(gpu, &plate(height_m, spot()), &options, technique);
            let name = technique.name;
            assert!((width / right - 1.0).abs() < 0.25, "{name}, {height_m} m: {width} instead of {right}");
            println!("{name}, {height_m} m: {width} m wide, {right} m expected");
        }
    }
}
