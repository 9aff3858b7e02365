//! Scenes that get easier.

use super::*;

/// Costs of levels that fit, each at most `most_ratio` times that of the next, and all well above timer noise.
fn light(most_ratio: f64) -> impl Strategy<Value = Vec<f64>> {
    let ratios = proptest::collection::vec(1.0..most_ratio, 0..6);
    (ratios, 0.1..0.3 * BUDGET_MS).prop_map(|(ratios, best)| {
        let below = ratios.iter().scan(best, |cost, ratio| {
            *cost = (*cost / ratio).max(0.1);
            Some(*cost)
        });
        std::iter::once(best).chain(below).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn a_heavy_start_is_forgotten(
        costs in light(4.0),
        load in 1.0..200.0_f64,
        frames in 0..400_usize,
        noise in 0.0..0.1,
        seed: u64,
    ) {
        let mut controller = controller(costs.len());
        let heavy: Vec<f64> = costs.iter().map(|cost| cost * load).collect();
        let mut scene = Scene { noise, random: seed, ..Scene::steady(&heavy) };
        scene.play(&mut controller, frames);
        scene.costs_ms = costs;
        scene.play(&mut controller, 3000);
        prop_assert_eq!(controller.level(), 0);
    }

    #[test]
    fn heavy_moments_are_forgotten_once_the_load_is_lower_for_a_while(
        costs in light(2.0),
        moments in proptest::collection::vec((1..300_usize, 10.0..200.0_f64, 1..100_usize), 1..12),
        noise in 0.0..0.1,
        seed: u64,
    ) {
        let mut controller = controller(costs.len());
        let mut scene = Scene { noise, random: seed, ..Scene::steady(&costs) };
        for (steady, load, heavy) in moments {
            scene.costs_ms = costs.clone();
            scene.play(&mut controller, steady);
            scene.costs_ms = costs.iter().map(|cost| cost * load).collect();
            scene.play(&mut controller, heavy);
        }
        for load in [1.0, 0.3, 1.0] {
            scene.costs_ms = costs.iter().map(|cost| cost * load).collect();
            scene.play(&mut controller, 100);
        }
        // Every level may have to wait for the longest.
        scene.play(&mut controller, costs.len() * (LONGEST_WAIT + 100));
        prop_assert_eq!(controller.level(), 0);
    }
}

#[test]
fn a_load_that_ends_during_the_step_down_does_not_keep_it_down() {
    let mut controller = controller(2);
    let change = (0..12).filter(|_| controller.update(100.0)).count();
    assert_eq!(change, 1);
    // Now 0.5 at both levels: 200 times less.
    let back = (1..).find(|_| controller.update(0.5));
    assert_eq!(back, Some(FIRST_WAIT));
    assert!((0..5000).all(|_| !controller.update(0.5)));
}

#[test]
fn a_ratio_is_trusted_once_a_step_up_was_reverted() {
    let mut controller = controller(2);
    let levels = Scene::steady(&[6.0, 0.6]).play(&mut controller, 30_000);
    assert_eq!(changes(&levels), 3, "down, up for a try, and down permanently");
    // At half the load it is no longer trusted, but half is still too much for level 0.
    let levels = Scene::steady(&[3.0, 0.29]).play(&mut controller, 30_000);
    assert_eq!(changes(&levels), 2);
    let levels = Scene::steady(&[1.4, 0.14]).play(&mut controller, 30_000);
    assert_eq!((changes(&levels), controller.level()), (1, 0));
}

#[test]
fn a_ratio_of_a_heavy_moment_during_a_try_is_trusted_until_the_load_changes() {
    let mut controller = controller(2);
    let mut play = |ms: f64, frames: usize| (0..frames).filter(|_| controller.update(ms)).count();
    assert_eq!(play(100.0, 12), 1);
    assert_eq!(play(0.5, FIRST_WAIT), 1);
    assert_eq!(play(100.0, 12), 1, "as if level 0 took that long");
    assert_eq!(play(0.5, 30_000), 0);
    assert_eq!(play(0.2, 100), 1);
    assert_eq!(play(0.5, 30_000), 0);
}

#[test]
fn a_ratio_of_a_load_that_ends_during_a_try_is_not_trusted() {
    let mut controller = controller(2);
    let mut play = |ms: f64, frames: usize| (0..frames).filter(|_| controller.update(ms)).count();
    assert_eq!(play(10.0, 12), 1);
    assert_eq!(play(0.75, FIRST_WAIT), 1);
    assert_eq!(play(10.0, 12), 1);
    // The level costs far less than before the try.
    assert_eq!(play(0.25, 2 * FIRST_WAIT), 1);
    assert_eq!(play(0.25, 5000), 0);
}

#[test]
fn a_doubled_load_invalidates_the_ratio_as_well() {
    let mut controller = controller(2);
    let mut play = |ms: f64, frames: usize| (0..frames).filter(|_| controller.update(ms)).count();
    assert_eq!(play(100.0, 12), 1);
    assert_eq!(play(0.3, FIRST_WAIT), 1);
    assert_eq!(play(100.0, 12), 1);
    assert_eq!(play(0.3, 5000), 0);
    assert_eq!(play(0.59, 5000), 0);
    assert_eq!(play(0.61, 5000), 1);
}
