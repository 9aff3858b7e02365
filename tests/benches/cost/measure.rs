//! Medians of several workloads that are measured alternately, so that other load affects all of them equally.

use std::time::{Duration, Instant};

/// Runs one frame and returns its measured time.
pub(crate) type Workload<'s> = Box<dyn FnMut() -> Duration + 's>;

/// Number of rounds of exact figures.
pub(crate) const ROUNDS: usize = 151;
/// Approximate duration of a sample.
const SAMPLE_DURATION: Duration = Duration::from_millis(2);

/// The measurement of a workload.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured {
    /// Median time of a frame in seconds.
    pub(crate) seconds: f64,
    /// Median over the rounds of the time relative to the first workload in the same round.
    pub(crate) ratio: f64,
}

/// A workload with its whole time.
pub(crate) fn timed<'s>(mut frame: impl FnMut() + 's) -> Workload<'s> {
    Box::new(move || {
        let start = Instant::now();
        frame();
        start.elapsed()
    })
}

/// Measures the workloads alternately, in [`ROUNDS`].
pub(crate) fn measure<const N: usize>(workloads: [Workload<'_>; N]) -> [Measured; N] {
    measure_in(ROUNDS, workloads)
}

/// Measures the workloads alternately, in `count` rounds.
pub(crate) fn measure_in<const N: usize>(count: usize, mut workloads: [Workload<'_>; N]) -> [Measured; N] {
    let frames = workloads.each_mut().map(|workload| frames(workload));
    let mut rounds: Vec<[f64; N]> = Vec::with_capacity(count);
    for round in 0..count {
        let mut seconds = [0.0; N];
        for turn in 0..N {
            // Every other round is reversed, so that each workload follows each other one.
            let at = if round % 2 == 0 { turn } else { N - 1 - turn };
            seconds[at] = turn_of(&mut workloads[at], frames[at]);
        }
        rounds.push(seconds);
    }
    std::array::from_fn(|at| Measured {
        seconds: median(rounds.iter().map(|seconds| seconds[at])),
        ratio: median(rounds.iter().map(|seconds| seconds[at] / seconds[0])),
    })
}

/// Warms a workload up, and returns its frames per round.
fn frames(workload: &mut Workload<'_>) -> u32 {
    let start = Instant::now();
    let mut count = 0;
    while start.elapsed() < SAMPLE_DURATION * 10 {
        workload();
        count += 1;
    }
    (count / 10).max(1)
}

/// Returns the seconds of a frame.
fn turn_of(workload: &mut Workload<'_>, frames: u32) -> f64 {
    let time: Duration = (0..frames).map(|_| workload()).sum();
    time.as_secs_f64() / f64::from(frames)
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
