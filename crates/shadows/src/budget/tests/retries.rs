//! Scenes in which the better level seems to fit again and again, and never does.

use super::*;

/// Feeds times that shrink to a quarter once the first times of the cheaper level are measured. Returns the frames at
/// which the level changed, and whether it was raised.
fn provoke(controller: &mut QualityController, frames: usize) -> Vec<(usize, bool)> {
    let mut since = 0;
    let mut changes = Vec::new();
    for frame in 0..frames {
        let ms = match (controller.level(), since) {
            (0, _) => 1.2 * BUDGET_MS,
            (_, 0..20) => 0.8 * BUDGET_MS,
            _ => 0.2 * BUDGET_MS,
        };
        since += 1;
        if controller.update(ms) {
            since = 0;
            changes.push((frame, controller.level() == 0));
        }
    }
    changes
}

/// Returns how long it stayed down each time, frames.
fn waits(changes: &[(usize, bool)]) -> Vec<usize> {
    changes.windows(2).filter(|pair| pair[1].1).map(|pair| pair[1].0 - pair[0].0).collect()
}

#[test]
fn the_wait_doubles_with_each_reverted_step_up_to_a_limit() {
    let waits = waits(&provoke(&mut controller(2), 20_000));
    assert_eq!(waits[..7], [72, 144, 288, 576, 1152, 2304, 2304]);
    assert_eq!((FIRST_WAIT, LONGEST_WAIT), (72, 2304));
    assert!(waits[7..].iter().all(|wait| *wait == LONGEST_WAIT));
}

#[test]
fn in_the_long_run_less_than_one_frame_in_a_hundred_is_over_budget() {
    let changes = provoke(&mut controller(2), 20_000);
    let tries = changes.windows(2).filter(|pair| pair[0].1 && pair[0].0 > 5000);
    let over: usize = tries.map(|pair| pair[1].0 - pair[0].0).sum();
    assert!(over > 0 && over * 100 < 15_000, "{over}");
}

#[test]
fn the_wait_is_short_again_after_the_better_level_held() {
    let mut controller = controller(2);
    provoke(&mut controller, 10_000);
    // This time the better level fits.
    let up = (0..5000).any(|_| controller.level() == 0 || controller.update(0.2 * BUDGET_MS));
    assert!(up && controller.level() == 0);
    let mut held = controller.clone();
    assert!((0..LONGEST_WAIT - WINDOW).all(|_| !controller.update(0.2 * BUDGET_MS)));
    assert!((0..LONGEST_WAIT).all(|_| !held.update(0.2 * BUDGET_MS)));
    assert_eq!(waits(&provoke(&mut controller, 20_000))[0], LONGEST_WAIT);
    assert_eq!(waits(&provoke(&mut held, 20_000))[..2], [FIRST_WAIT, 2 * FIRST_WAIT]);
}

#[test]
fn each_level_has_its_own_wait() {
    let mut controller = controller(3);
    // Steps up to level 1 are reverted until its wait is the longest; level 0 is not tried.
    assert!((0..24).filter(|_| controller.update(2.0 * BUDGET_MS)).count() == 2);
    let mut since = 0;
    for _ in 0..15_000 {
        let ms = match (controller.level(), since) {
            (0 | 1, _) => 1.2 * BUDGET_MS,
            (_, 0..20) => 0.8 * BUDGET_MS,
            _ => 0.2 * BUDGET_MS,
        };
        since = if controller.update(ms) { 0 } else { since + 1 };
        assert_ne!(controller.level(), 0);
    }
    let ups = |controller: &mut QualityController| (0..).find(|_| controller.update(0.2 * BUDGET_MS));
    while controller.level() == 2 {
        ups(&mut controller);
    }
    assert_eq!(ups(&mut controller), Some(LATENCY + WINDOW - 1), "level 0 was left long ago");
}
