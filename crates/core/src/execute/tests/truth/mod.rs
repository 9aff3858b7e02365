//! Random small graphs of integer arithmetic, run on a device that draws, give exactly the numbers of an interpreter that
//! only follows the order of declaration.

mod copies;
mod declare;
mod gpu;
mod graph;
mod interpret;
mod make;
mod maker;
mod random;
mod run;

use crate::test_device::{drawing, noop};
use crate::{Plan, SlotReason};
use gpu::Gpu;
use graph::Graph;
use run::{Failure, Runner};
use std::fmt::Write as _;

/// Returns a number of graphs, raised in proportion where `PROPTEST_CASES` asks for more than its default, 256.
fn graph_count() -> u64 {
    120 * u64::from(proptest::test_runner::Config::default().cases.div_ceil(256))
}

/// Graphs that are submitted and compared together.
const BATCH: usize = 10;

#[test]
fn random_graphs_compute_the_results_of_the_interpreter() {
    let Some(device) = drawing() else { return };
    let gpu = Gpu::new(device);
    let mut runner = Runner::new(&gpu);
    let mut counts = Counts::default();
    let graphs: Vec<_> = (0..graph_count()).map(Graph::random).collect();
    for batch in graphs.chunks(BATCH) {
        match runner.run(batch, true) {
            Ok(words) => counts.words += words,
            Err(failure) => panic!("{}", report(&gpu, batch, &failure)),
        }
        for (graph, plan) in batch.iter().zip(runner.plans.drain(..)) {
            counts.add(graph, &plan);
        }
    }
    println!("{} graphs: {counts:?}", graphs.len());
    counts.assert_covered(graphs.len());
}

#[test]
fn random_graphs_are_valid_on_a_device_with_default_limits() {
    let gpu = Gpu::new(noop());
    let mut runner = Runner::new(&gpu);
    let graphs: Vec<_> = (1_000_000..1_000_040).map(Graph::random).collect();
    for batch in graphs.chunks(BATCH) {
        if let Err(failure) = runner.run(batch, false) {
            panic!("{}", report(&gpu, batch, &failure));
        }
    }
}

/// Number of graphs that contained each of the tested features.
#[derive(Debug, Default)]
struct Counts {
    passes: usize,
    culled: usize,
    merged: usize,
    clears_drawn: usize,
    discards: usize,
    slots: usize,
    slots_reused: usize,
    reordered: usize,
    histories: usize,
    words: usize,
}

impl Counts {
    fn add(&mut self, graph: &Graph, plan: &Plan) {
        self.passes += plan.pass_count();
        self.culled += plan.culled_count();
        self.merged += plan.steps().map(|step| step.passes.len() - 1).sum::<usize>();
        let ops = plan.order().iter().flat_map(|&pass| plan.accesses(pass)).filter_map(|access| access.ops);
        for ops in ops {
            self.clears_drawn += usize::from(ops.clear_drawn);
            self.discards += usize::from(ops.store == crate::StoreAction::Discard);
        }
        self.slots += plan.slots().len();
        let reused = |reason| matches!(reason, SlotReason::After(_));
        self.slots_reused += plan.resources().filter(|(_, resource)| reused(resource.slot_reason)).count();
        self.reordered += usize::from(!plan.order().is_sorted());
        self.histories += graph.histories();
    }

    /// Asserts that the graphs contained all tested features.
    fn assert_covered(&self, graphs: usize) {
        let Self { culled, merged, clears_drawn, discards, slots_reused, reordered, histories, .. } = *self;
        let counts = [culled, merged, clears_drawn, discards, slots_reused, reordered, histories];
        assert!(counts.iter().all(|&count| count >= graphs / 8), "{self:?}");
    }
}

/// Describes a failure with the smallest graph that still fails in the same way, and its plan.
fn report(gpu: &Gpu, batch: &[Graph], failure: &Failure) -> String {
    let alone = |graph: &Graph| Runner::new(gpu).run(std::slice::from_ref(graph), true).err();
    let mut text = failure.text.clone();
    let fails = |graph: &Graph| alone(graph).is_some_and(|own| own.kind == failure.kind);
    let Some(graph) = batch.iter().find(|graph| fails(graph)) else {
        let seeds: Vec<_> = batch.iter().map(|graph| graph.seed).collect();
        let _ =
            write!(text, "\nno graph of the seeds {seeds:?} fails alone, so it is what earlier ones left");
        return text;
    };
    let smallest = without_needless_passes(graph.clone(), fails);
    let mut runner = Runner::new(gpu);
    let failure = runner.run(std::slice::from_ref(&smallest), true).err();
    let _ =
        writeln!(text, "\nseed {} alone: {}", smallest.seed, failure.map_or(String::new(), |own| own.text));
    for line in smallest.lines() {
        let _ = writeln!(text, "{line}");
    }
    for plan in &runner.plans {
        let _ = writeln!(text, "{}", plan.to_text());
    }
    text
}

/// Removes passes one by one while the graph still fails.
fn without_needless_passes(mut graph: Graph, fails: impl Fn(&Graph) -> bool) -> Graph {
    for index in (0..graph.passes.len()).rev() {
        let mut smaller = graph.clone();
        smaller.passes.remove(index);
        if fails(&smaller) {
            graph = smaller;
        }
    }
    graph
}
