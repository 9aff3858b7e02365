//! `shadowgraph bench --fly`: the CPU time of frames with a camera that moves, and what the scene costs to load and to keep.

use std::time::{Duration, Instant};

use shadowgraph::lighting::CullPass;
use shadowgraph::scene::Camera;
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_quality::bench::{Stats, flying_frames};

use super::commands::Input;
use super::failure::Failure;

/// Distance that the camera moves in each frame, metres.
const FLOWN_M: f64 = 0.05;

/// Measures frames, and returns the lines to print. `read` is the time in which the scene was read.
pub(crate) fn fly(
    gpu: &Gpu,
    input: Input,
    view: &ViewOptions,
    frames: u32,
    read: Duration,
) -> Result<String, Failure> {
    let start = Instant::now();
    let mut renderer = input.renderer(gpu)?;
    let uploaded = start.elapsed();
    let camera = |frame| flown(&view.camera, frame);
    let times = flying_frames(gpu, &mut renderer, (view.size_px, &view.shadows), frames, camera)?;
    let memory = memory_line(&renderer, view)?;
    let peak =
        peak_bytes().map_or_else(String::new, |peak| format!("; peak memory of the process {}", mib(peak)));
    let [read, uploaded] = [read, uploaded].map(|time| time.as_secs_f64());
    Ok(format!(
        "{}read in {read:.2} s, uploaded in {uploaded:.2} s{peak}\n{memory}",
        times_line(&times, &renderer)
    ))
}

/// Returns the camera of a frame that moves ahead.
fn flown(camera: &Camera, frame: u32) -> Camera {
    let step = camera.forward_world() * (FLOWN_M * f64::from(frame));
    let mut flown = camera.clone();
    flown.world_from_view.translation += step;
    flown
}

fn times_line(frames: &[Duration], renderer: &Renderer) -> String {
    let stats = Stats::from_samples(frames.iter().map(|time| time.as_secs_f64() * 1e3));
    let by = if renderer.casters().culls_on_gpu() { "GPU" } else { "CPU" };
    format!(
        "CPU time of a frame with a moving camera, {} instances culled by the {by}, {} frames: median {:.3} ms, 95th percentile {:.3} ms\n",
        renderer.casters().scene.instance_count(),
        frames.len(),
        stats.median,
        stats.p95
    )
}

/// Returns the memory of instances on the GPU.
fn memory_line(renderer: &Renderer, view: &ViewOptions) -> Result<String, Failure> {
    let scene = &renderer.casters().scene;
    let (plan, _) = renderer.plan(view)?;
    let culling = plan
        .resources()
        .filter(|(_, resource)| resource.slot.is_some() && CullPass::BUFFERS.contains(&resource.name));
    let lists: u64 = culling.map(|(_, resource)| resource.desc.bytes()).sum();
    let bytes = scene.instance_bytes();
    Ok(format!(
        "instances on the GPU: {}, {:.0} bytes each; lists of the culled views: {}\n",
        mib(bytes),
        bytes as f64 / scene.instance_count().max(1) as f64,
        mib(lists)
    ))
}

fn mib(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

/// Returns the most memory that the process has used so far, where the system says so.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kib: u64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(kib * 1024)
}
