//! Measures a GPU and runs the pixel tests on it: `cargo xtask gpu-report` puts this program into a directory with all that it needs.
//!
//! It writes `gpu-report.json` and a page of the same figures, `gpu-report.html`.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line tool prints for its user")]
#![allow(clippy::expect_used, reason = "the frames of the benchmark are constants")]

mod arguments;
mod data;
#[path = "../../../benches/cost/drawing.rs"]
mod drawing;
#[path = "../../../../crates/core/tests/frames/mod.rs"]
#[allow(dead_code, reason = "the benchmark of the graph uses more of it")]
mod frames;
#[path = "../../../benches/cost/graph.rs"]
#[allow(dead_code, reason = "the benchmark of the graph uses more of it")]
mod graph;
mod graph_cost;
#[path = "../../../benches/cost/hand.rs"]
mod hand;
#[path = "../../../benches/cost/measure.rs"]
#[allow(dead_code, reason = "the benchmark of the graph uses more of it")]
mod measure;
mod page;
mod pixels;
mod scenes;
mod work;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use arguments::Arguments;
use data::{AdapterData, Report};
use shadowgraph::Gpu;
use shadowgraph::wgpu::DeviceType;
use work::Work;

fn main() -> ExitCode {
    let arguments = match Arguments::parse(std::env::args().skip(1)) {
        Ok(Some(arguments)) => arguments,
        Ok(None) => {
            print!("{}", arguments::HELP);
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(2);
        }
    };
    let gpu = match Gpu::open(&arguments.adapter.0) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("error: {error}");
            return ExitCode::from(3);
        }
    };
    match run(&arguments, &gpu) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments, gpu: &Gpu) -> Result<(), String> {
    let adapter = AdapterData::new(&gpu.adapter);
    println!("{}, {}", adapter.name, adapter.driver);
    let work = Work::new(arguments, gpu.adapter.device_type == DeviceType::Cpu);
    let mut report = Report::new(adapter, work.size_px);
    // Written after each part: what was measured stays if a later part fails.
    let (choice, name) = &arguments.adapter;
    timed("graph", || graph_cost::measure(choice, work.rounds).map(|costs| report.graph = costs))?;
    write(&report, &arguments.output)?;
    for scene in scenes::sources(&work)? {
        let part = scene.name.clone();
        timed(&part, || scene.measure(gpu, &work).map(|data| report.scenes.push(data)))?;
        write(&report, &arguments.output)?;
    }
    if arguments.pixel_tests {
        timed("pixel tests", || pixels::run(name).map(|tests| report.pixel_tests = Some(tests)))?;
        write(&report, &arguments.output)?;
    }
    println!("wrote {} and gpu-report.html", arguments.output.join("gpu-report.json").display());
    Ok(())
}

/// Runs a part and prints how long it took.
fn timed(part: &str, run: impl FnOnce() -> Result<(), String>) -> Result<(), String> {
    let start = Instant::now();
    run()?;
    println!("{part}: {:.1} s", start.elapsed().as_secs_f64());
    Ok(())
}

fn write(report: &Report, directory: &Path) -> Result<(), String> {
    let json = serde_json::to_string_pretty(report).map_err(|error| error.to_string())? + "\n";
    for (name, text) in [("gpu-report.json", json), ("gpu-report.html", page::page(report))] {
        let file = directory.join(name);
        std::fs::create_dir_all(directory)
            .and_then(|()| std::fs::write(&file, text))
            .map_err(|error| format!("cannot write {}: {error}", file.display()))?;
    }
    Ok(())
}
