//! The cost of the graph on a real driver, relative to the same passes by hand.

use std::time::Instant;

use shadowgraph::Gpu;

use crate::data::GraphCost;
use crate::drawing::Drawing;
use crate::frames::Change;
use crate::frames::chain::Chain;
use crate::graph::Whole;
use crate::hand::Hand;
use crate::measure::{ROUNDS, Workload, measure_in};

/// Number of rounds on software drivers, which draw a thousand passes in seconds.
const SOFTWARE_ROUNDS: usize = 3;

/// Measures frames of 10, 100 and 1,000 passes.
pub(crate) fn measure(gpu: &Gpu, software: bool) -> Result<Vec<GraphCost>, String> {
    let drawing = Drawing::new(gpu.device.clone(), gpu.queue.clone());
    let rounds = if software { SOFTWARE_ROUNDS } else { ROUNDS };
    Ok([10, 100, 1_000].into_iter().map(|length| measure_chain(&drawing, length, rounds)).collect())
}

fn measure_chain(drawing: &Drawing, length: usize, rounds: usize) -> GraphCost {
    let chain = Chain::new(length);
    let hand = Hand::new(drawing, &chain);
    let [unchanged, changed] = [Change::Never, Change::Pass].map(|change| {
        let mut whole = Whole::new(drawing, &chain, change);
        waited(drawing, move || whole.frame())
    });
    let workloads = [waited(drawing, move || hand.frame()), unchanged, changed];
    let [hand, unchanged, changed] = measure_in(rounds, workloads);
    GraphCost {
        passes: length,
        by_hand_us: hand.seconds * 1e6,
        unchanged: unchanged.ratio,
        changed: changed.ratio,
    }
}

/// A workload with the time until it has submitted its frame. It then waits until the GPU has drawn it, so that frames do not queue up.
fn waited<'s>(drawing: &'s Drawing, mut frame: impl FnMut() + 's) -> Workload<'s> {
    Box::new(move || {
        let start = Instant::now();
        frame();
        let time = start.elapsed();
        // A lost device shows in the pixel tests.
        let _ = drawing.device.poll(shadowgraph::wgpu::PollType::wait_indefinitely());
        time
    })
}
