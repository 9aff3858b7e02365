//! Light along the creases of surfaces in shadow, compared with rays.

use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::Scene;
use shadowgraph::shadows::{EVSM, PCF, PCSS, RAYTRACED, SDSM, TechniqueKind};
use shadowgraph::{Gpu, ViewOptions};
use shadowgraph_quality::built_in_cases;
use shadowgraph_samples::test_scenes::test_scene;

use super::{Greys, greys_with};
use crate::stage::{
    add_mesh, box_mesh, camera, draw_with, floor_mesh, gpu, hard, material, sun, sun_direction, view,
};

/// Returns a Cornell box of planes under a low sun, seen from two sides.
fn boxes(elevation_deg: f64) -> (Scene, Vec<ViewOptions>) {
    let cases = built_in_cases().unwrap().cases;
    let case = cases.iter().find(|case| case.name() == "cornell").unwrap();
    let mut scene = test_scene("cornell").unwrap();
    scene.insert_light(case.sun(elevation_deg));
    let views =
        case.views.iter().map(|shown| ViewOptions { size_px: [640, 360], ..view(shown.camera(), 14.0) });
    (scene, views.collect())
}

/// Counts the pixels that are too light by more than one half, and those that are too dark by the same amount.
fn too_light_and_too_dark(greys: &Greys, truth: &Greys) -> [usize; 2] {
    let pairs = || greys.iter().zip(truth).filter_map(|(grey, truth)| Some(((*grey)?, (*truth)?)));
    let light = pairs().filter(|(grey, truth)| *grey > truth.saturating_add(127)).count();
    [light, pairs().filter(|(grey, truth)| *truth > grey.saturating_add(127)).count()]
}

/// Returns the visibility of a sun with a disc.
fn soft_truth(gpu: &Gpu, scene: &Scene, options: &ViewOptions) -> Greys {
    let image = draw_with(gpu, scene, Aov::Visibility(0), options, RAYTRACED).image;
    image.rgba8.chunks_exact(4).map(|rgba| (rgba[3] == 255).then_some(rgba[0])).collect()
}

#[test]
fn row_60_light_does_not_leak_along_creases() {
    let Some(gpu) = gpu() else { return };
    let mut counts = [(PCF, [0; 4]), (PCSS, [0; 4]), (EVSM, [0; 4]), (SDSM, [0; 4])];
    for elevation_deg in [15.0, 30.0, 52.0] {
        let (scene, views) = boxes(elevation_deg);
        for mut options in views {
            let truth = soft_truth(gpu, &scene, &options);
            for (technique, counts) in &mut counts {
                for (closed, at) in [(false, 0), (true, 2)] {
                    options.shadows.close_creases = closed;
                    let greys = greys_with(gpu, &scene, 0, &options, *technique);
                    let [light, dark] = too_light_and_too_dark(&greys, &truth);
                    counts[at] += light;
                    counts[at + 1] += dark;
                }
            }
        }
    }
    for (technique, [light_before, dark_before, light, dark]) in counts {
        println!("{technique:?}: too light {light_before} -> {light}, too dark {dark_before} -> {dark}");
        assert!(light_before > 300 && light * 10 < light_before, "{technique:?}: {light_before} {light}");
        assert!(dark < 10, "{technique:?}: {dark}");
    }
    save_images(gpu);
}

/// Saves images for the docs, where they are requested.
fn save_images(gpu: &Gpu) {
    let Some(dir) = shadowgraph_tests::images() else { return };
    let (scene, views) = boxes(15.0);
    for (closed, name) in [(false, "creases-open.png"), (true, "creases-closed.png")] {
        let mut options = views[1].clone();
        options.shadows.close_creases = closed;
        let image = draw_with(gpu, &scene, Aov::Visibility(0), &hard(&options), PCF).image;
        let [width, height] = options.size_px;
        let image = image::RgbaImage::from_raw(width, height, image.rgba8).unwrap();
        // A corner of the floor and two walls.
        let corner = image::imageops::crop_imm(&image, 185, 190, 160, 90).to_image();
        corner.save(dir.join(name)).unwrap();
    }
}

/// Compares images with and without the setting, which must be equal where the light arrives.
fn assert_unchanged(scene: &Scene, options: &ViewOptions, technique: TechniqueKind) {
    let Some(gpu) = gpu() else { return };
    let with = greys_with(gpu, scene, 0, options, technique);
    let mut options = options.clone();
    options.shadows.close_creases = false;
    let without = greys_with(gpu, scene, 0, &options, technique);
    let truth = greys_with(gpu, scene, 0, &options, RAYTRACED);
    let lit = || (0..truth.len()).filter(|at| truth[*at] == Some(255));
    assert!(lit().count() > 10_000, "{}", lit().count());
    let changed = lit().filter(|at| with[*at] != without[*at]).count();
    assert_eq!(changed, 0, "{technique:?}, {} px", options.shadows.cascades.map_size_px);
}

#[test]
fn row_60_creases_that_the_light_reaches_stay_lit() {
    // The sun is behind the camera: a wall, a groove narrower than texels, and a step, whose front sides are all lit.
    let mut scene = Scene::default();
    let parts = [
        (DVec3::new(-2.0, 0.0, -1.0), DVec3::new(2.0, 1.0, -0.8)),
        (DVec3::new(-2.0, 0.0, -0.8), DVec3::new(2.0, 0.2, -0.3)),
        (DVec3::new(-2.0, 0.0, 0.2), DVec3::new(-0.01, 0.05, 1.0)),
        (DVec3::new(0.01, 0.0, 0.2), DVec3::new(2.0, 0.05, 1.0)),
    ];
    scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(3.0), DVec3::ZERO);
    for (min, max) in parts {
        add_mesh(&mut scene, box_mesh(min, max), DVec3::ZERO);
    }
    scene.insert_light(sun(sun_direction(25.0, 10.0)));
    for map_size_px in [256, 1024, 4096] {
        let mut options = view(camera(DVec3::new(0.5, 1.5, 2.5), DVec3::new(0.0, 0.3, -0.5)), 20.0);
        options.shadows.cascades.map_size_px = map_size_px;
        for technique in [PCF, PCSS, EVSM] {
            assert_unchanged(&scene, &options, technique);
        }
    }
}
