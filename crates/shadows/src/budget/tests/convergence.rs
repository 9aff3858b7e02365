//! Scenes whose levels have constant costs.

use super::*;

/// Enough for every level to be left, tried again and left for good.
const SETTLED: usize = 8000;

/// Costs so far from the budget, and from where the next better level might fit, that noise does not matter.
fn clear_cost() -> impl Strategy<Value = f64> {
    let might_fit = 0.4 * BUDGET_MS;
    prop_oneof![0.0..might_fit / 1.11, might_fit / 0.89..BUDGET_MS / 1.11, BUDGET_MS / 0.89..20.0 * BUDGET_MS]
}

fn scene(cost: impl Strategy<Value = f64>) -> impl Strategy<Value = Scene> {
    // One slow frame in three is at most three in nine.
    let slow_every = prop_oneof![Just(0_usize), 3..200_usize];
    let costs = proptest::collection::vec(cost, 1..10);
    (costs, 0.0..0.1, slow_every, any::<u64>()).prop_map(|(costs_ms, noise, slow_every, random)| Scene {
        costs_ms,
        noise,
        slow_every,
        random,
        frame: 0,
    })
}

/// Returns the first level that fits, or the cheapest.
fn best_level(costs: &[f64]) -> usize {
    costs.iter().position(|cost| *cost <= BUDGET_MS).unwrap_or(costs.len() - 1)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn it_settles_at_the_best_level_that_fits(mut scene in scene(clear_cost())) {
        let mut controller = controller(scene.costs_ms.len());
        scene.play(&mut controller, SETTLED);
        prop_assert_eq!(controller.level(), best_level(&scene.costs_ms));
        let levels = scene.play(&mut controller, 20_000);
        prop_assert_eq!(changes(&levels), 0);
    }

    #[test]
    fn it_settles_even_if_costs_are_close_to_the_budget(
        mut scene in scene(prop_oneof![BUDGET_MS * 0.9..BUDGET_MS * 1.1, 0.0..20.0 * BUDGET_MS]),
    ) {
        let levels_count = scene.costs_ms.len();
        let mut controller = controller(levels_count);
        let levels = scene.play(&mut controller, 30_000);
        // Down once to each level, and up and down once more.
        prop_assert!(changes(&levels) <= 3 * (levels_count - 1), "{} changes", changes(&levels));
    }

    #[test]
    fn it_never_goes_back_if_levels_differ_by_less_than_a_factor_of_two_and_a_half(
        ratios in proptest::collection::vec(1.0..2.4_f64, 1..9),
        worst in 0.0..20.0 * BUDGET_MS,
        seed: u64,
    ) {
        let costs = std::iter::once(&1.0).chain(&ratios).scan(worst, |cost, ratio| {
            *cost /= ratio;
            Some(*cost)
        });
        let costs: Vec<f64> = costs.collect();
        let mut scene = Scene { noise: 0.01, random: seed, ..Scene::steady(&costs) };
        let levels = scene.play(&mut controller(costs.len()), 5000);
        prop_assert!(levels.is_sorted());
    }
}

#[test]
fn a_level_of_almost_no_cost_is_kept_despite_timer_noise() {
    for ticks in [[0.0, 0.0], [0.0, 0.005], [0.001, 0.015]] {
        let mut controller = controller(2);
        let mut scene = Scene::steady(&[3.0, 0.0]);
        let mut levels = Vec::new();
        for i in 0..200 {
            scene.costs_ms[1] = ticks[i % 2];
            levels.extend(scene.play(&mut controller, 100));
        }
        assert!(changes(&levels) <= 3, "{} changes", changes(&levels));
        assert_eq!(controller.level(), 1);
    }
}

#[test]
fn a_time_of_zero_is_valid() {
    let mut controller = controller(2);
    assert_eq!((0..12).filter(|_| controller.update(3.0)).count(), 1);
    assert_eq!((0..FIRST_WAIT).filter(|_| controller.update(0.0)).count(), 1);
}
