//! CPU cost of a frame: `cargo bench -p shadowgraph-tests --bench cost`.
//!
//! Criterion computes the statistics of single figures; the table at the end compares them with their targets, and
//! whole frames with the same passes written by hand, measured alternately in the same run. `-- table` prints only the
//! table. `-- frames KIND PASSES FRAMES` only runs frames, for a profiler; `KIND` is `hand`, `unchanged`, `clear` or `pass`.
#![allow(clippy::expect_used, clippy::print_stdout, reason = "a benchmark")]

mod drawing;
#[path = "../../../crates/core/tests/frames/mod.rs"]
mod frames;
mod graph;
mod hand;
mod measure;
mod table;

use criterion::{BenchmarkId, Criterion, Throughput};
use drawing::Drawing;
use frames::Change;
use frames::chain::Chain;
use graph::{Declared, Source, Whole};
use hand::Hand;
use measure::{Workload, measure, timed};
use shadowgraph_core::wgpu;
use table::{Table, Target};

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [command, kind, passes, frames, ..] = &arguments[..]
        && command == "frames"
    {
        let parse = |number: &String| number.parse().expect("PASSES and FRAMES are numbers");
        return run_frames(kind, parse(passes), parse(frames));
    }
    let mut criterion = Criterion::default().configure_from_args();
    single_figures(&mut criterion);
    criterion.final_summary();
    // Listing, profiling and the single run of `cargo test --benches` measure nothing.
    let measures_nothing = ["--test", "--list", "--profile-time"];
    if !std::env::args().any(|argument| measures_nothing.contains(&argument.as_str())) {
        let mut table = Table::default();
        declaring(&mut table);
        growth(&mut table);
        real_frame(&mut table);
        by_hand(&mut table);
        on_threads(&mut table);
        table.print();
    }
}

fn single_figures(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("declare and compile");
    for length in [100, 3_000] {
        let chain = Chain::new(length);
        group.throughput(Throughput::Elements(length as u64));
        for change in Change::ALL {
            let mut declared = Declared::new(Source::Chain(&chain), change);
            let id = BenchmarkId::new(change.name(), length);
            group.bench_function(id, |bencher| bencher.iter(|| declared.frame()));
        }
    }
    group.throughput(Throughput::Elements(frames::real::PASSES as u64));
    for change in Change::ALL {
        let mut declared = Declared::new(Source::Real, change);
        let id = BenchmarkId::new(change.name(), "real");
        group.bench_function(id, |bencher| bencher.iter(|| declared.frame()));
    }
    group.finish();
}

/// A workload that declares and compiles.
fn declares<'c>(source: Source<'c>, change: Change) -> Workload<'c> {
    let mut declared = Declared::new(source, change);
    timed(move || {
        declared.frame();
    })
}

/// A workload that declares and compiles, with only the time of compiling.
fn compiles<'c>(source: Source<'c>, change: Change) -> Workload<'c> {
    let mut declared = Declared::new(source, change);
    Box::new(move || declared.frame())
}

fn declaring(table: &mut Table) {
    table.heading("declare and compile, each pass");
    for length in [100, 3_000] {
        let chain = Chain::new(length);
        let measured = measure(Change::ALL.map(|change| declares(Source::Chain(&chain), change)));
        let targets = [Target::Micros(0.15), Target::None, Target::Micros(1.0), Target::None];
        for ((change, measured), target) in Change::ALL.into_iter().zip(measured).zip(targets) {
            let figure = format!("{length} passes, {}", change.name());
            table.row(&figure, measured.seconds / length as f64, None, target);
        }
    }
}

fn growth(table: &mut Table) {
    table.heading("compile");
    let chains = [1_000, 10_000].map(Chain::new);
    let workloads = chains.each_ref().map(|chain| compiles(Source::Chain(chain), Change::Pass));
    let [short, long] = measure(workloads);
    table.row("1,000 passes", short.seconds, None, Target::None);
    table.row("10,000 passes, against 1,000", long.seconds, Some(long.ratio), Target::Times(12.0));
}

fn real_frame(table: &mut Table) {
    let kinds = [Change::Never, Change::Pass];
    table.heading("compile, 65 passes with 350 accesses");
    let measured = measure(kinds.map(|change| compiles(Source::Real, change)));
    let targets = [Target::Micros(10.0), Target::Micros(60.0)];
    for ((change, measured), target) in kinds.into_iter().zip(measured).zip(targets) {
        table.row(change.name(), measured.seconds, None, target);
    }
    table.heading("declare and compile, 65 passes with 350 accesses");
    for (change, measured) in
        kinds.into_iter().zip(measure(kinds.map(|change| declares(Source::Real, change))))
    {
        table.row(change.name(), measured.seconds, None, Target::None);
    }
}

/// Creates the objects of frames on a no-op device, so that only CPU work is measured.
fn drawing() -> Drawing {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    Drawing::new(device, queue)
}

/// Runs frames of one kind.
fn run_frames(kind: &str, passes: usize, frames: usize) {
    let (drawing, chain) = (drawing(), Chain::new(passes));
    let whole = |change| {
        let mut whole = Whole::new(&drawing, &chain, change);
        (0..frames).for_each(|_| whole.frame());
    };
    match kind {
        "hand" => {
            let hand = Hand::new(&drawing, &chain);
            (0..frames).for_each(|_| hand.frame());
        }
        "unchanged" => whole(Change::Never),
        "clear" => whole(Change::Clear),
        "pass" => whole(Change::Pass),
        _ => println!("unknown KIND `{kind}`; allowed: hand, unchanged, clear, pass"),
    }
}

fn by_hand(table: &mut Table) {
    for length in [10, 100, 1_000] {
        // A device each: on a shared one, the later a texture is created, the more passes cost that use it.
        let drawings: [Drawing; 4] = std::array::from_fn(|_| drawing());
        table.heading(&format!("whole frame of {length} passes with one draw each"));
        let chain = Chain::new(length);
        let hand = Hand::new(&drawings[0], &chain);
        let graph = |drawing, change| {
            let mut whole = Whole::new(drawing, &chain, change);
            timed(move || whole.frame())
        };
        let [hand, unchanged, clear, pass] = measure([
            timed(move || hand.frame()),
            graph(&drawings[1], Change::Never),
            graph(&drawings[2], Change::Clear),
            graph(&drawings[3], Change::Pass),
        ]);
        table.row("by hand", hand.seconds, None, Target::None);
        for (change, measured, target) in
            [(Change::Never, unchanged, 1.05), (Change::Clear, clear, 1.3), (Change::Pass, pass, 1.3)]
        {
            table.row(change.name(), measured.seconds, Some(measured.ratio), Target::Times(target));
        }
    }
}

fn on_threads(table: &mut Table) {
    let drawing = drawing();
    let chain = Chain::new(32);
    for draws in [1, 10, 100, 1_000] {
        table.heading(&format!("whole frame of 32 passes with {draws} draws each"));
        let workloads = [1, 2, 4].map(|threads| {
            let mut whole = Whole::new(&drawing, &chain, Change::Never).with_draws(draws, threads);
            timed(move || whole.frame())
        });
        for (threads, measured) in [1, 2, 4].into_iter().zip(measure(workloads)) {
            table.row(&format!("threads: {threads}"), measured.seconds, Some(measured.ratio), Target::None);
        }
    }
}
