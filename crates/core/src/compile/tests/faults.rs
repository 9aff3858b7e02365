//! The oracle is tested itself: faults planted in one stage of the compiler, each of which it must report.

mod contents;
mod order;
mod reasons;
mod stages;
mod storage;

use super::frames::{Spec, small_frame_from_bytes};
use super::oracle::{Rule, check_plan};
use super::random_bytes;
use stages::{Stage, Work, compile};

/// Number of times a fault could be planted in random frames, and number of times one of `rules` was found broken.
struct Found {
    planted: usize,
    caught: usize,
    missed: Option<String>,
}

const FRAMES: u64 = 800;

/// Plants a fault in random frames wherever possible: `plant` returns whether it did. It may be called after several
/// stages.
fn search(rules: &[Rule], plant: impl Fn(Stage, &mut Work) -> Option<bool>) -> Found {
    let mut found = Found { planted: 0, caught: 0, missed: None };
    for seed in 0..FRAMES {
        let spec = small_frame_from_bytes(&random_bytes(seed, 700), 16);
        let (mut frame, names) = spec.build();
        let decl = std::mem::take(&mut frame.decl);
        let mut planted = false;
        let plan = compile(decl.clone(), |stage, work| {
            if let Some(done) = plant(stage, work) {
                planted |= done;
            }
        });
        if !planted || plan == compile(decl, |_, _| {}) {
            continue;
        }
        found.planted += 1;
        let breaches = check_plan(&spec, &names, &plan);
        if breaches.iter().any(|breach| rules.contains(&breach.rule)) {
            found.caught += 1;
        } else if found.missed.is_none() {
            found.missed = Some(format!("{breaches:?}\n{}\n{spec}", plan.to_text()));
        }
    }
    found
}

impl Found {
    /// Checks that most, or at least many, faults were caught, where a fault may do no harm in a frame.
    fn caught(self, least: usize) {
        let Self { planted, caught, missed } = self;
        assert!(caught >= least, "caught {caught} of {planted}: {}", missed.unwrap_or_default());
    }

    /// Checks that every fault was caught, where faults always do harm.
    fn always_caught(self) {
        let Self { planted, caught, missed } = self;
        assert!(planted >= 20, "planted {planted} times only");
        assert!(caught == planted, "caught {caught} of {planted}: {}", missed.unwrap_or_default());
    }
}

#[test]
fn without_a_fault_nothing_is_reported() {
    for seed in 0..FRAMES {
        let spec: Spec = small_frame_from_bytes(&random_bytes(seed, 700), 16);
        let (mut frame, names) = spec.build();
        let plan = compile(std::mem::take(&mut frame.decl), |_, _| {});
        assert_eq!(check_plan(&spec, &names, &plan), []);
    }
}
