//! Shadows in pixels that are wider than the texels of a map, compared with the mean of rays over each pixel.

use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Light, LightKind, Scene};
use shadowgraph::shadows::{PCF, PCSS, RAYTRACED, Technique};
use shadowgraph::{Gpu, ViewOptions};
use shadowgraph_samples::test_scenes::test_scene;

use crate::stage::{SIZE_PX, camera, draw_with, gpu, hard, light, sun, sun_direction, view};

/// Pixels of the large image along each axis of a pixel of the small one.
const RATIO: u32 = 4;

/// Returns the visibility at each pixel; -1 where there is no surface.
fn visibility(gpu: &Gpu, scene: &Scene, options: &ViewOptions, technique: impl Into<Technique>) -> Vec<f64> {
    let frame = draw_with(gpu, scene, Aov::Visibility(0), options, technique.into());
    let value = |rgba: &[u8]| if rgba[3] == 255 { f64::from(rgba[0]) / 255.0 } else { -1.0 };
    frame.image.rgba8.chunks_exact(4).map(value).collect()
}

/// Returns the mean over each block of pixels; -1 where a pixel has no surface.
fn means(pixels: &[f64]) -> Vec<f64> {
    let [width, height] = SIZE_PX.map(|size| size / RATIO);
    let mean = |i: u32| {
        let (x, y) = (i % width * RATIO, i / width * RATIO);
        let block =
            (0..RATIO * RATIO).map(|j| pixels[((y + j / RATIO) * SIZE_PX[0] + x + j % RATIO) as usize]);
        let has_surface = block.clone().all(|value| value >= 0.0);
        if has_surface { block.sum::<f64>() / f64::from(RATIO * RATIO) } else { -1.0 }
    };
    (0..width * height).map(mean).collect()
}

/// Returns the root mean square difference of pixels that show surfaces in both images.
fn rmse(image: &[f64], truth: &[f64]) -> f64 {
    let pairs = image.iter().zip(truth).filter(|(a, b)| **a >= 0.0 && **b >= 0.0);
    (pairs.clone().map(|(a, b)| (a - b).powi(2)).sum::<f64>() / pairs.count() as f64).sqrt()
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
fn row_42_wide_pixels_show_the_mean_of_their_shadows() {
    let Some(gpu) = gpu() else { return };
    for (light, technique) in lights().into_iter().flat_map(|light| [(light.clone(), PCF), (light, PCSS)]) {
        let (scene, mut options) = fence(light);
        (options.shadows.cascades.map_size_px, options.shadows.atlas.map_size_px) = (8192, 4096);
        let truth = means(&visibility(gpu, &scene, &hard(&options), RAYTRACED));
        options.size_px = SIZE_PX.map(|size| size / RATIO);
        let with = rmse(&visibility(gpu, &scene, &options, technique), &truth);
        options.shadows.supersample = false;
        let without = rmse(&visibility(gpu, &scene, &options, technique), &truth);
        println!("{:?}, {technique:?}: {with:.4}, one lookup {without:.4}", scene.lights()[0].kind);
        assert!(with < 0.7 * without, "{technique:?}: {with} {without}");
    }
}

#[test]
fn row_42_narrow_pixels_have_one_lookup() {
    let Some(gpu) = gpu() else { return };
    for light in lights() {
        let (scene, mut options) = fence(light);
        (options.shadows.cascades.map_size_px, options.shadows.atlas.map_size_px) = (256, 256);
        let with = visibility(gpu, &scene, &options, PCF);
        options.shadows.supersample = false;
        assert_eq!(with, visibility(gpu, &scene, &options, PCF));
    }
}
