//! The cost of the graph on a real driver, relative to the same passes by hand.

use std::time::Instant;

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;

use crate::data::GraphCost;
use crate::drawing::Drawing;
use crate::frames::Change;
use crate::frames::chain::Chain;
use crate::graph::Whole;
use crate::hand::Hand;
use crate::measure::{Workload, measure_in};

/// Measures frames of 10, 100 and 1,000 passes.
///
/// # Errors
/// The adapter does not open.
pub(crate) fn measure(adapter: &AdapterChoice, rounds: usize) -> Result<Vec<GraphCost>, String> {
    [10, 100, 1_000].into_iter().map(|length| measure_chain(adapter, length, rounds)).collect()
}

/// Measures frames of one length, each side on a separate device: on a shared one, each would pay for the textures of all.
fn measure_chain(adapter: &AdapterChoice, length: usize, rounds: usize) -> Result<GraphCost, String> {
    let drawing = || {
        let gpu = Gpu::open(adapter).map_err(|error| error.to_string())?;
        Ok::<_, String>(Drawing::new(gpu.device, gpu.queue))
    };
    let [by_hand, same, other] = [drawing()?, drawing()?, drawing()?];
    let chain = Chain::new(length);
    let hand = Hand::new(&by_hand, &chain);
    let [unchanged, changed] = [(&same, Change::Never), (&other, Change::Pass)].map(|(drawing, change)| {
        let mut whole = Whole::new(drawing, &chain, change);
        waited(drawing, move || whole.frame())
    });
    let workloads = [waited(&by_hand, move || hand.frame()), unchanged, changed];
    let [hand, unchanged, changed] = measure_in(rounds, workloads);
    Ok(GraphCost {
        passes: length,
        by_hand_us: hand.seconds * 1e6,
        unchanged: unchanged.ratio,
        changed: changed.ratio,
    })
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
