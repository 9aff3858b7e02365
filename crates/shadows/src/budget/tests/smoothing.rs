//! Outliers and invalid times.

use super::*;

proptest! {
    #[test]
    fn up_to_four_slow_frames_in_nine_change_nothing(
        slow in proptest::sample::subsequence((0..WINDOW).collect::<Vec<_>>(), 0..=4),
        cost in 0.0..=BUDGET_MS,
        slow_ms in 0.0..1e9,
    ) {
        let mut controller = controller(3);
        for frame in 0..300 {
            let ms = if slow.contains(&(frame % WINDOW)) { slow_ms } else { cost };
            prop_assert!(!controller.update(ms));
        }
    }

    #[test]
    fn invalid_times_are_ignored(
        costs in proptest::collection::vec(0.0..2.0 * BUDGET_MS, 4),
        junk in proptest::collection::vec(0..12_usize, 400),
        seed: u64,
    ) {
        let bad = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, -f64::MIN_POSITIVE];
        let mut scene = Scene { noise: 0.5, random: seed, ..Scene::steady(&costs) };
        let (mut clean, mut noisy) = (controller(4), controller(4));
        for junk in junk {
            if let Some(bad) = bad.get(junk) {
                prop_assert!(!noisy.update(*bad));
            }
            let ms = scene.measure(clean.level());
            prop_assert_eq!(clean.update(ms), noisy.update(ms));
            prop_assert_eq!(&clean, &noisy);
        }
    }

    #[test]
    fn the_same_times_give_the_same_levels(times in proptest::collection::vec(0.0..3.0 * BUDGET_MS, 0..400)) {
        let run = || {
            let mut controller = controller(5);
            times.iter().map(|ms| (controller.update(*ms), controller.level())).collect::<Vec<_>>()
        };
        prop_assert_eq!(run(), run());
    }

    #[test]
    fn no_number_makes_it_panic(
        times in proptest::collection::vec(proptest::num::f64::ANY, 0..400),
        extreme in proptest::collection::vec(proptest::sample::select(vec![0.0, -0.0, 5e-324, f64::MAX]), 0..400),
    ) {
        let mut controller = controller(4);
        for ms in times.into_iter().chain(extreme) {
            controller.update(ms);
            prop_assert!(controller.level() < 4);
        }
    }
}

#[test]
fn the_first_frames_after_a_change_are_skipped() {
    let mut controller = controller(3);
    let slow = BUDGET_MS * 1.01;
    let to_change = |controller: &mut QualityController| (1..).find(|_| controller.update(slow)).unwrap();
    assert_eq!(to_change(&mut controller), LATENCY + WINDOW);
    // The last frames of the level before do not count, however slow.
    for _ in 0..LATENCY {
        assert!(!controller.update(1e9));
    }
    for _ in 0..WINDOW - 5 {
        assert!(!controller.update(1e9));
    }
    for _ in 0..5 {
        assert!(!controller.update(1.0));
    }
    assert_eq!(controller.level(), 1);
}

#[test]
fn five_slow_frames_in_nine_lower_the_level_once() {
    let mut controller = controller(3);
    let mut play = |ms: f64, frames: usize| (0..frames).filter(|_| controller.update(ms)).count();
    assert_eq!(play(1.0, 100), 0);
    assert_eq!(play(2.5, 4), 0);
    assert_eq!(play(2.5, 1), 1);
    assert_eq!(play(2.5, LATENCY + WINDOW - 1), 0);
    assert_eq!(play(2.5, 1), 1);
    assert_eq!(play(2.5, 1000), 0, "there is no cheaper level");
    assert_eq!(controller.level(), 2);
}
