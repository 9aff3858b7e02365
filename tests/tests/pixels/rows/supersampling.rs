//! Shadows in pixels that are wider than the texels of a map, compared with the mean of rays over each pixel.

use glam::DVec3;
use shadowgraph::ViewOptions;
use shadowgraph::scene::{Light, LightKind, Scene};
use shadowgraph::shadows::{PCF, PCSS, RAYTRACED};
use shadowgraph_samples::test_scenes::test_scene;

use super::{Greys, greys_with};
use crate::stage::{SIZE_PX, camera, gpu, light, sun, sun_direction, view};

/// Pixels of the large image along each axis of a pixel of the small one.
const RATIO: u32 = 4;

/// Returns the mean over each block of pixels; `None` where a pixel has none.
fn means(greys: &Greys) -> Vec<Option<f64>> {
    let [width, height] = SIZE_PX.map(|size| size / RATIO);
    let mean = |i: u32| {
        let (x, y) = (i % width * RATIO, i / width * RATIO);
        let grey = |j: u32| greys[((y + j / RATIO) * SIZE_PX[0] + x + j % RATIO) as usize].map(f64::from);
        let sum = (0..RATIO * RATIO).map(grey).sum::<Option<f64>>()?;
        Some(sum / f64::from(RATIO * RATIO))
    };
    (0..width * height).map(mean).collect()
}

/// Returns the root mean square difference of the pixels that both images have.
fn rmse(greys: &Greys, truth: &[Option<f64>]) -> f64 {
    let difference = |(grey, truth): (&Option<u8>, &Option<f64>)| Some(f64::from((*grey)?) - (*truth)?);
    let differences: Vec<f64> = greys.iter().zip(truth).filter_map(difference).collect();
    (differences.iter().map(|d| d * d).sum::<f64>() / differences.len() as f64).sqrt()
}

/// Returns the ground behind a fence, with narrow shadows.
fn fence(light: Light) -> (Scene, ViewOptions) {
    let mut scene = test_scene("slats").unwrap();
    scene.set_lights([light]);
    let options = view(camera(DVec3::new(0.1, 1.5, 1.4), DVec3::new(0.0, 0.0, 1.3)), 40.0);
    (scene, options)
}

fn lights() -> [Light; 2] {
    let kind = LightKind::Spot {
        position_world: DVec3::new(2.0, 5.0, -4.0),
        direction: DVec3::new(-2.0, -5.0, 4.0).normalize(),
        range: Some(30.0),
        inner_angle: 0.4,
        outer_angle: 0.5,
    };
    [sun(sun_direction(40.0, 160.0)), light(kind, 20_000.0)]
}

#[test]
fn row_59_wide_pixels_show_the_mean_of_their_shadows() {
    let Some(gpu) = gpu() else { return };
    for (light, technique) in lights().into_iter().flat_map(|light| [(light.clone(), PCF), (light, PCSS)]) {
        let (scene, mut options) = fence(light);
        (options.shadows.cascades.map_size_px, options.shadows.atlas.map_size_px) = (8192, 4096);
        let truth = means(&greys_with(gpu, &scene, 0, &options, RAYTRACED));
        options.size_px = SIZE_PX.map(|size| size / RATIO);
        let with = rmse(&greys_with(gpu, &scene, 0, &options, technique), &truth);
        options.shadows.supersample = false;
        let without = rmse(&greys_with(gpu, &scene, 0, &options, technique), &truth);
        println!("{:?}, {technique:?}: {with:.4}, one lookup {without:.4}", scene.lights()[0].kind);
        assert!(with < 0.7 * without, "{technique:?}: {with} {without}");
    }
}

#[test]
fn row_59_narrow_pixels_have_one_lookup() {
    let Some(gpu) = gpu() else { return };
    for light in lights() {
        let (scene, mut options) = fence(light);
        (options.shadows.cascades.map_size_px, options.shadows.atlas.map_size_px) = (256, 256);
        let with = greys_with(gpu, &scene, 0, &options, PCF);
        options.shadows.supersample = false;
        assert_eq!(with, greys_with(gpu, &scene, 0, &options, PCF));
    }
}
