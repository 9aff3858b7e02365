//! Cached maps.

use super::{Greys, count, pillar_view, pillars, spot};
use crate::stage::{gpu, light, sun, sun_direction};
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Light, LightKind, Scene};
use shadowgraph::{Renderer, ViewOptions};

fn lights(shift: f64) -> Vec<Light> {
    let at = DVec3::new(0.4 + shift, 3.0, -8.0);
    let point = light(LightKind::Point { position_world: at, range: Some(14.0) }, 900.0);
    let spot_light = spot(DVec3::new(0.0, 4.0, -2.0), DVec3::new(0.5, 0.0, -6.0), 0.7);
    vec![sun(sun_direction(35.0, 60.0)), spot_light, point]
}

fn scene() -> Scene {
    let mut scene = pillars(12);
    scene.set_lights(lights(0.0));
    scene
}

fn view(step: f64, cache: bool) -> ViewOptions {
    let mut options = pillar_view(|settings| {
        settings.cascades.cache = cache;
        settings.atlas.cache = cache;
        settings.atlas.map_size_px = 1024;
        settings.cascades.map_size_px = 1024;
    });
    let eye = DVec3::new(0.3 + step, 2.5, 5.0 - step);
    options.camera = crate::stage::camera(eye, DVec3::new(0.0, 0.5, -15.0));
    options
}

/// Returns the names of the passes that draw into maps.
fn tiles(plan: &shadowgraph::core::Plan) -> Vec<String> {
    let live = plan.order().iter().map(|&pass| plan.pass_path(pass).to_string());
    let of_map = live.filter(|path| !path.ends_with(" static"));
    of_map.filter(|path| path.contains("/cascade ") || path.contains("/light ")).collect()
}

fn draw(renderer: &mut Renderer, options: &ViewOptions) -> (Greys, Vec<String>) {
    let drawn = renderer.draw(gpu().unwrap(), options).unwrap();
    let greys = drawn.image.rgba8.chunks_exact(4).map(|rgba| (rgba[3] == 255).then_some(rgba[0]));
    (greys.collect(), tiles(&drawn.plan))
}

#[test]
fn row_41_cached_maps_give_the_image_of_maps_rendered_every_frame() {
    let Some(gpu) = gpu() else { return };
    for shown in 0..3 {
        let make = || Renderer::new(gpu, scene(), &view(0.0, true).camera, Aov::Visibility(shown)).unwrap();
        let (mut cached, mut uncached) = (make(), make());
        let mut redrawn = Vec::new();
        // The camera rests, moves, rests, a light moves, rests, the atlas changes its size, rests.
        for (step, shift, size) in [
            (0.0, 0.0, 1024),
            (0.0, 0.0, 1024),
            (0.3, 0.0, 1024),
            (0.6, 0.0, 1024),
            (0.6, 0.0, 1024),
            (0.6, 0.2, 1024),
            (0.6, 0.2, 1024),
            (0.6, 0.2, 2048),
            (0.6, 0.2, 2048),
        ] {
            let [with, without] = [(&mut cached, true), (&mut uncached, false)].map(|(renderer, cache)| {
                renderer.scene_mut().set_lights(lights(shift));
                let mut options = view(step, cache);
                options.shadows.atlas.map_size_px = size;
                draw(renderer, &options)
            });
            let differ = super::different(&with.0, &without.0, 0);
            let shown_in_one =
                with.0.iter().zip(&without.0).filter(|(a, b)| a.is_some() != b.is_some()).count();
            assert_eq!(
                (differ, shown_in_one),
                (0, 0),
                "light {shown}, step {step}, shift {shift}, size {size}"
            );
            assert!(count(&with.0, |grey| grey < 255) > 50);
            redrawn.push((with.1.len(), without.1.len()));
        }
        let (with, without): (Vec<_>, Vec<_>) = redrawn.into_iter().unzip();
        assert!(without.iter().all(|tiles| *tiles >= 6), "{without:?}");
        // Nothing is rendered while nothing changes.
        assert_eq!([with[1], with[4], with[6], with[8]], [0; 4], "{with:?}");
        // Moving the camera renders cascades again, and once the tiles of other lights, with casters that it did not see;
        // moving a light renders its own tiles.
        assert!(with[0] >= 8 && with[3] <= 4 && (1..=6).contains(&with[5]), "{with:?}");
    }
}

#[test]
fn row_41_a_frame_that_was_only_planned_caches_nothing() {
    let Some(gpu) = gpu() else { return };
    let options = view(0.0, true);
    let mut renderer = Renderer::new(gpu, scene(), &options.camera, Aov::Visibility(1)).unwrap();
    let (plan, _) = renderer.plan(&options).unwrap();
    assert!(tiles(&plan).len() >= 8);
    let (_, drawn) = draw(&mut renderer, &options);
    assert_eq!(drawn.len(), tiles(&plan).len());
    assert!(tiles(&renderer.plan(&options).unwrap().0).is_empty());
}
