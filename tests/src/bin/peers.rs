//! Compares whole frames with those of another renderer, in turns: `cargo run --release -p shadowgraph-tests --bin peers -- PROGRAM CASES
//! SCENES [ROUNDS]`.
//!
//! CASES is a JSON file with views of scenes (`{"cases": [{"name", "glb", "camera": {"eye", "target", "fov_deg"}, "sun", "size"}]}`), SCENES the
//! directory of their files. PROGRAM is called with a file of one case, SCENES, a directory for output, and `frames=N`; it prints the median
//! time of a frame and the processor time of its main thread, waiting for the GPU after each frame, as the first two numbers with a unit.
//! Both draw one sun with shadows up to 150 m. Prints a Markdown table of medians over the rounds.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line tool prints for its user")]

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Duration;

use glam::DVec3;
use serde::Deserialize;
use shadowgraph::options::{AdapterChoice, Aov};
use shadowgraph::scene::{Camera, Light, Projection, Scene, gltf};
use shadowgraph::shadows::ShadowSettings;
use shadowgraph::{Gpu, Pipeline, Renderer, ViewOptions};
use shadowgraph_quality::bench::{Stats, WholeFrame, whole_frames};

/// Frames of each measurement.
const FRAMES: u32 = 12;

/// The shadow distance, metres: that of the other renderer.
const DISTANCE_M: f32 = 150.0;

#[derive(Deserialize)]
struct Cases {
    cases: Vec<serde_json::Value>,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    glb: PathBuf,
    camera: View,
    sun: DVec3,
    size: [u32; 2],
}

#[derive(Deserialize)]
struct View {
    eye: DVec3,
    target: DVec3,
    fov_deg: f64,
}

/// Times of a frame, milliseconds: until the GPU has finished, and the processor time of the thread.
#[derive(Clone, Copy)]
struct Times {
    frame: f64,
    thread: f64,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let rounds = |text: &str| text.parse().ok().filter(|&rounds| rounds > 0);
    let done = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [program, cases, scenes] => compare(program, Path::new(cases), Path::new(scenes), 3),
        [program, cases, scenes, rounds_text] => match rounds(rounds_text) {
            Some(rounds) => compare(program, Path::new(cases), Path::new(scenes), rounds),
            None => Err(format!("ROUNDS: expected a number of at least 1, got `{rounds_text}`")),
        },
        _ => Err("expected PROGRAM CASES SCENES [ROUNDS]".into()),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Measures all cases, and prints a row for each as it is done.
fn compare(program: &str, cases: &Path, scenes: &Path, rounds: usize) -> Result<(), String> {
    let text = std::fs::read_to_string(cases).map_err(|error| format!("{}: {error}", cases.display()))?;
    let Cases { cases } = serde_json::from_str(&text).map_err(|error| error.to_string())?;
    let gpu = Gpu::open(&AdapterChoice::Auto).map_err(|error| error.to_string())?;
    println!("{}, medians of {rounds} rounds of {FRAMES} frames, milliseconds\n", gpu.adapter.name);
    println!("| scene | peer | thread | `minimal_lit` | thread | ratios | `forward` | ratio |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for value in cases {
        let case: Case = serde_json::from_value(value.clone()).map_err(|error| error.to_string())?;
        let scene = scene(&case, scenes)?;
        let mut times = [const { Vec::new() }; 3];
        for _ in 0..rounds {
            times[0].push(peer(program, &value, scenes)?);
            for (times, pipeline) in times[1..].iter_mut().zip([Pipeline::minimal_lit(), Pipeline::forward()])
            {
                times.push(own(&gpu, &scene, &case, pipeline)?);
            }
        }
        let [peer, bare, forward] = times.map(|times| median(&times));
        println!(
            "| {} | {:.0} | {:.1} | {:.0} | {:.1} | {:.2}, {:.2} | {:.0} | {:.2} |",
            case.name,
            peer.frame,
            peer.thread,
            bare.frame,
            bare.thread,
            bare.frame / peer.frame,
            bare.thread / peer.thread,
            forward.frame,
            forward.frame / peer.frame,
        );
    }
    Ok(())
}

fn scene(case: &Case, scenes: &Path) -> Result<Scene, String> {
    let mut scene = gltf::load(&scenes.join(&case.glb)).map_err(|error| error.to_string())?;
    scene.set_lights(vec![Light::sun(case.sun, 10_000.0)]);
    Ok(scene)
}

/// Measures a case with the other program.
fn peer(program: &str, case: &serde_json::Value, scenes: &Path) -> Result<Times, String> {
    let directory = tempfile::tempdir().map_err(|error| error.to_string())?;
    let file = directory.path().join("case.json");
    let text = serde_json::json!({ "cases": [case] }).to_string();
    std::fs::write(&file, text).map_err(|error| error.to_string())?;
    let output = Command::new(program)
        .args([&file, scenes, directory.path()])
        .arg(format!("frames={FRAMES}"))
        .output()
        .map_err(|error| format!("{program}: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let words: Vec<&str> = text.split_whitespace().collect();
    let mut numbers =
        words.windows(2).filter(|pair| pair[1].starts_with("ms")).filter_map(|pair| pair[0].parse().ok());
    match (numbers.next(), numbers.next()) {
        (Some(frame), Some(thread)) if output.status.success() => Ok(Times { frame, thread }),
        _ => Err(format!("{program} printed no times: {}", String::from_utf8_lossy(&output.stderr))),
    }
}

/// Measures a case with a pipeline of this project.
fn own(gpu: &Gpu, scene: &Scene, case: &Case, pipeline: Pipeline) -> Result<Times, String> {
    let View { eye, target, fov_deg } = case.camera;
    let projection = Projection::Perspective { fov_y: fov_deg.to_radians(), near: 0.1, far: None };
    let camera = Camera::look_at(eye, target, DVec3::Y, projection);
    let shadows = ShadowSettings { distance_m: DISTANCE_M, ..ShadowSettings::default() };
    let options = ViewOptions { camera, size_px: case.size, shadows };
    let mut renderer = Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Color, pipeline)
        .map_err(|error| error.to_string())?;
    let frames = whole_frames(gpu, &mut renderer, &options, FRAMES).map_err(|error| error.to_string())?;
    let of = |time: fn(&WholeFrame) -> Duration| {
        Stats::from_samples(frames.iter().map(|frame| time(frame).as_secs_f64() * 1e3)).median
    };
    Ok(Times { frame: of(|frame| frame.wall), thread: of(|frame| frame.thread) })
}

fn median(times: &[Times]) -> Times {
    let of = |time: fn(&Times) -> f64| Stats::from_samples(times.iter().map(time)).median;
    Times { frame: of(|times| times.frame), thread: of(|times| times.thread) }
}
