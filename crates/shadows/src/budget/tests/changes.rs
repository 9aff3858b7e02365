//! Checks every change of level against the whole history, in scenes whose load jumps.

use super::*;

/// Costs of four levels, and loads with the frames that they last.
fn any_history() -> impl Strategy<Value = (Vec<f64>, Vec<(f64, usize)>, u64)> {
    let costs = (0.5..4.0_f64, 1.0..5.0_f64, 1.0..3.0_f64, 0.8..2.0_f64)
        .prop_map(|(best, a, b, c)| vec![best, best / a, best / a / b, best / a / b / c]);
    let load = (-2.0..2.0_f64).prop_map(f64::exp2);
    (costs, proptest::collection::vec((load, 1..400_usize), 1..12), any::<u64>())
}

/// The times that a controller was given, and its levels.
struct History {
    times: Vec<f64>,
    /// The level after each time.
    levels: Vec<usize>,
}

fn play(costs: &[f64], loads: &[(f64, usize)], seed: u64) -> History {
    let mut scene = Scene { noise: 0.1, random: seed, ..Scene::steady(costs) };
    let mut controller = controller(costs.len());
    let mut past = History { times: Vec::new(), levels: Vec::new() };
    for (load, frames) in loads {
        for _ in 0..*frames {
            past.times.push(scene.measure(controller.level()) * load);
            controller.update(past.times[past.times.len() - 1]);
            past.levels.push(controller.level());
        }
    }
    past
}

impl History {
    fn level_before(&self, frame: usize) -> usize {
        if frame == 0 { 0 } else { self.levels[frame - 1] }
    }

    /// Returns the frames at which the level changed.
    fn changes(&self) -> impl DoubleEndedIterator<Item = usize> {
        (0..self.levels.len()).filter(|&frame| self.level_before(frame) != self.levels[frame])
    }

    /// Returns the median of the frames up to this one.
    fn median(&self, frame: usize) -> f64 {
        let mut last = self.times[frame + 1 - WINDOW..=frame].to_vec();
        last.sort_by(f64::total_cmp);
        last[WINDOW / 2]
    }

    fn was_lowered(&self, frame: usize) -> bool {
        self.levels[frame] > self.level_before(frame)
    }

    /// Returns the cost of the level before over that of `level`, at the last step down to it.
    fn ratio(&self, before: usize, level: usize) -> f64 {
        let down =
            self.changes().rfind(|&f| f < before && self.levels[f] == level && self.was_lowered(f)).unwrap();
        (self.median(down) / self.median(down + LATENCY + WINDOW)).max(1.0)
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn levels_change_by_one_and_a_full_window_apart((costs, loads, seed) in any_history()) {
        let past = play(&costs, &loads, seed);
        let changes: Vec<_> = past.changes().collect();
        for frame in &changes {
            prop_assert_eq!(past.levels[*frame].abs_diff(past.level_before(*frame)), 1);
        }
        let first = changes.iter().map(|frame| frame + 1).take(1);
        for frames in first.chain(changes.windows(2).map(|pair| pair[1] - pair[0])) {
            prop_assert!(frames >= LATENCY + WINDOW, "{} frames", frames);
        }
    }

    #[test]
    fn the_level_is_lowered_exactly_when_the_median_is_over_budget((costs, loads, seed) in any_history()) {
        let past = play(&costs, &loads, seed);
        let mut since = 0;
        for frame in 0..past.times.len() {
            since += 1;
            let is_checked = since >= LATENCY + WINDOW;
            let over = is_checked && past.median(frame) > BUDGET_MS && past.level_before(frame) + 1 < costs.len();
            prop_assert_eq!(past.was_lowered(frame), over, "frame {}", frame);
            since = if past.levels[frame] == past.level_before(frame) { since } else { 0 };
        }
    }

    #[test]
    fn the_level_is_raised_only_if_that_is_expected_to_fit_with_headroom((costs, loads, seed) in any_history()) {
        let past = play(&costs, &loads, seed);
        for frame in past.changes().filter(|&frame| !past.was_lowered(frame)) {
            let ratio = past.ratio(frame, past.level_before(frame));
            prop_assert!(past.median(frame) * ratio.min(2.0) <= 0.8 * BUDGET_MS);
        }
    }

    #[test]
    fn the_level_is_never_raised_soon_after_it_was_lowered((costs, loads, seed) in any_history()) {
        let past = play(&costs, &loads, seed);
        let mut down = None;
        for frame in past.changes() {
            if past.was_lowered(frame) {
                down = Some(frame);
            } else {
                prop_assert!(frame - down.unwrap() >= FIRST_WAIT);
            }
        }
    }
}

#[test]
fn histories_go_both_ways() {
    let loads = [(4.0, 60), (0.5, 400), (3.0, 100), (0.3, 400)];
    let past = play(&[1.5, 1.0, 0.7, 0.5], &loads, 1);
    let (down, up): (Vec<_>, Vec<_>) = past.changes().partition(|&frame| past.was_lowered(frame));
    assert!(down.len() >= 4 && up.len() >= 4, "{} down, {} up", down.len(), up.len());
}

#[test]
fn the_level_is_raised_as_soon_as_the_better_one_fits_with_headroom() {
    // A ratio of 1.25, and one above 2 that is not trusted.
    for (better, cheaper, just) in [(2.5, 2.0, 1.28), (10.0, 1.0, 0.8)] {
        let mut controller = controller(2);
        let mut play = |ms: f64, frames: usize| (0..frames).filter(|_| controller.update(ms)).count();
        assert_eq!(play(better, 12), 1);
        assert_eq!(play(cheaper, 1000), 0);
        assert_eq!(play(just * 1.001, 1000), 0);
        assert_eq!(play(just * 0.999, 5), 1);
    }
}

#[test]
fn the_whole_budget_may_be_used() {
    let mut controller = controller(2);
    assert!((0..1000).all(|_| !controller.update(BUDGET_MS)));
}
