//! Several samples, and several views.

use super::{pillar_view, pillars};
use crate::stage::{SIZE_PX, gpu, sun, sun_direction};
use glam::DVec3;
use shadowgraph::Pipeline;
use shadowgraph::options::Aov;
use shadowgraph::scene::Scene;
use shadowgraph::shadows::PCF;
use shadowgraph::{Error, Gpu, RenderConfig, Renderer};

fn pillars_in_sun() -> Scene {
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    scene.insert_light(super::spot(DVec3::new(0.0, 4.0, -2.0), DVec3::new(0.5, 0.0, -6.0), 0.7));
    scene
}

#[test]
fn row_40_four_samples_smooth_edges_and_change_nothing_else() {
    let Some(gpu) = gpu() else { return };
    let options = pillar_view(|_| ());
    for pipeline in [Pipeline::minimal_lit(), Pipeline::screen_shadows(), Pipeline::minimal()] {
        let draw = |samples| {
            let config = RenderConfig { pipeline: pipeline.clone(), samples, ..RenderConfig::default() };
            let mut renderer =
                Renderer::with_config(gpu, pillars_in_sun(), &options.camera, Aov::Color, config).unwrap();
            renderer.draw(gpu, &options).unwrap().image.rgba8
        };
        let (one, four) = (draw(1), draw(4));
        // A pixel whose four neighbours have its colour is inside a surface.
        let [width, height] = SIZE_PX.map(|px| px as usize);
        let luma = |rgba8: &[u8], x: usize, y: usize| i32::from(rgba8[(y * width + x) * 4 + 1]);
        let (mut inside, mut changed, mut edges, mut smoothed) = (0, 0, 0, 0);
        for (x, y) in (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| (x, y))) {
            let here = luma(&one, x, y);
            let around = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)].map(|(x, y)| luma(&one, x, y));
            let differs = (luma(&four, x, y) - here).abs() > 3;
            if around.iter().all(|other| (other - here).abs() <= 2) {
                inside += 1;
                changed += usize::from(differs);
            } else if around.iter().any(|other| (other - here).abs() > 40) {
                edges += 1;
                smoothed += usize::from(differs);
            }
        }
        assert!(changed * 200 < inside, "{pipeline:?}: {changed} of {inside} inside");
        assert!(smoothed * 6 > edges && edges > 500, "{pipeline:?}: {smoothed} of {edges} at edges");
    }
}

#[test]
fn row_40_other_sample_counts_are_errors() {
    for samples in [0, 2, 3, 8, 16] {
        let config = RenderConfig { samples, ..RenderConfig::default() };
        let camera = pillar_view(|_| ()).camera;
        let made =
            Renderer::with_config(&Gpu::noop().unwrap(), pillars_in_sun(), &camera, Aov::Color, config);
        let error = made.err().map(|error| (matches!(error, Error::SampleCount { .. }), error.to_string()));
        assert!(error.is_some_and(|(known, text)| known && text.contains("1 or 4")));
    }
}

#[test]
fn row_40_two_cameras_in_one_frame_have_their_own_shadows() {
    let Some(gpu) = gpu() else { return };
    let left = pillar_view(|settings| settings.atlas.cache = true);
    let mut right = left.clone();
    right.camera = crate::stage::camera(DVec3::new(8.0, 6.0, -10.0), DVec3::new(0.0, 0.0, -14.0));
    right.size_px = [160, 120];
    for pipeline in [Pipeline::minimal_lit(), Pipeline::screen_shadows()] {
        let make = || {
            let aov = Aov::Visibility(0);
            Renderer::with_config(gpu, pillars_in_sun(), &left.camera, aov, pipeline.clone()).unwrap()
        };
        let mut together = make();
        for _ in 0..2 {
            let images = together.draw_views(gpu, &[left.clone(), right.clone()]).unwrap();
            for (image, options) in images.iter().zip([&left, &right]) {
                let alone = make().draw(gpu, options).unwrap().image;
                assert!(*image == alone, "{pipeline:?}");
                assert!(
                    alone.rgba8.chunks_exact(4).filter(|rgba| rgba[0] == 0 && rgba[3] == 255).count() > 100
                );
            }
            // The views differ.
            assert_ne!(images[0].size_px, images[1].size_px);
        }
        let (first, second) = (together.draw_views(gpu, std::slice::from_ref(&left)).unwrap(), make());
        assert_eq!(first.len(), 1);
        assert_eq!(*second.pipeline(), pipeline);
    }
    let none = Renderer::with_config(gpu, pillars_in_sun(), &left.camera, Aov::Color, PCF)
        .unwrap()
        .draw_views(gpu, &[]);
    assert!(none.unwrap().is_empty());
}
