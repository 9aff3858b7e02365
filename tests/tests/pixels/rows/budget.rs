//! Quality that follows a time budget.

use super::{count, greys, pillar_view, pillars, plan};
use crate::stage::{gpu, sun, sun_direction};
use shadowgraph::core::Timer;
use shadowgraph::options::Aov;
use shadowgraph::scene::Scene;
use shadowgraph::shadows::{BudgetConfig, NONE, PCF, QualityController, TilePlan};
use shadowgraph::{Renderer, ViewOptions};

/// Returns the time of a simulated GPU for the maps of a view, milliseconds: 1 ns for each cleared pixel, 5 us for each draw.
fn time_ms(scene: &Scene, options: &ViewOptions) -> f64 {
    let plan = plan(scene, options);
    let tiles = plan.cascades.iter().chain(&plan.atlas).flat_map(|map| &map.tiles);
    let time = |tile: &TilePlan| {
        f64::from(tile.rect.width) * f64::from(tile.rect.height) * 1e-6 + tile.casters.len() as f64 * 5e-3
    };
    tiles.map(time).sum()
}

#[test]
fn row_28_a_controller_keeps_shadows_within_a_time_budget() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    let best = pillar_view(|settings| settings.cascades.map_size_px = 4096);
    let mut now_ms = time_ms(&scene, &best);
    let budget_ms = now_ms / 6.0;
    let mut controller =
        QualityController::new(BudgetConfig { budget_ms, ..BudgetConfig::default() }).unwrap();
    let mut options = best.clone();
    let mut times = Vec::new();
    for _ in 0..300 {
        times.push(now_ms);
        if controller.update(now_ms) {
            options.shadows = controller.apply(&best.shadows);
            now_ms = time_ms(&scene, &options);
        }
    }
    assert!(times[0] > budget_ms && times[200..].iter().all(|time| *time <= budget_ms), "{times:?}");
    // No level of higher quality would fit.
    assert!(controller.level() > 1);
    // Shadows remain.
    let dark = [&best, &options].map(|options| count(&greys(gpu, &scene, 0, options), |grey| grey < 128));
    assert!(dark[1] * 2 > dark[0] && dark[1] < dark[0] * 2, "{dark:?}");
}

#[test]
fn row_28_the_time_of_the_shadow_passes_is_reported() {
    let Some(gpu) = gpu() else { return };
    let mut scene = pillars(2);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    let options = pillar_view(|_| ());
    let shadow_ms = |technique, timer: Option<&mut Timer>| {
        let mut renderer =
            Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Color, technique).unwrap();
        let drawn = renderer.draw_timed(gpu, &options, timer).unwrap();
        let all: Option<f64> = drawn.times.iter().map(|time| time.gpu_ms).sum();
        (drawn.shadow_ms(), all)
    };
    assert_eq!(shadow_ms(PCF, None), (None, Some(0.0)));
    let (Some(shadows), Some(all)) = shadow_ms(PCF, Some(&mut Timer::new())) else {
        return shadowgraph_tests::skip("shadow_ms", "the device has no timestamps");
    };
    assert!(shadows > 0.0 && shadows < all, "{shadows} of {all}");
    assert_eq!(shadow_ms(NONE, Some(&mut Timer::new())).0, Some(0.0));
}
