#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use super::*;
use shadowgraph::options::{AdapterChoice, ShadowDistance};
use shadowgraph::{Pipeline, RenderedImage};
use shadowgraph_core::{Frame, PassKind, Plan, Subresource};
use shadowgraph_samples::demo::demo_scene;
use shadowgraph_scene::{Camera, Light, Scene};
use shadowgraph_shadows::ShadowSettings;
use std::io::Write as _;

fn options(scene: &Scene, camera: &Camera) -> ViewOptions {
    let mut shadows = ShadowSettings::default().without_cache();
    shadows.cascades.map_size_px = 1024;
    shadows.atlas.map_size_px = 1024;
    ViewOptions { camera: camera.clone(), size_px: [160, 90], shadows }
        .with_shadow_distance(ShadowDistance::Auto, scene)
}

fn renderer(gpu: &Gpu, scene: Scene, camera: &Camera, aov: Aov) -> Renderer {
    Renderer::with_config(gpu, scene, camera, aov, Pipeline::minimal_lit()).unwrap()
}

fn demo(gpu: &Gpu) -> (Renderer, ViewOptions) {
    let scene = demo_scene();
    let camera = scene.cameras[0].clone();
    let options = options(&scene, &camera);
    (renderer(gpu, scene, &camera, Aov::Color), options)
}

/// Returns the passes that each render pass consists of.
fn render_passes(plan: &Plan) -> Vec<Vec<&str>> {
    let steps = plan.steps().filter(|step| plan.pass(step.passes[0]).kind == PassKind::Render);
    steps.map(|step| step.passes.iter().map(|&id| plan.pass(id).name).collect()).collect()
}

fn uploads(plan: &Plan) -> usize {
    plan.order().iter().filter(|&&id| plan.pass(id).kind == PassKind::Copy).count()
}

#[test]
fn the_hand_written_frame_has_as_many_passes_and_uploads_as_the_plan() {
    let gpu = Gpu::noop().unwrap();
    let (mut renderer, options) = demo(&gpu);
    let (plan, _) = renderer.plan(&options).unwrap();
    let counts = compare(&gpu, &mut renderer, &options, 1).unwrap().counts;
    let passes = render_passes(&plan);
    // The tiles of a map are passes of their own, merged into one render pass.
    let cascades = ["clear", "cascade 0", "cascade 1", "cascade 2", "cascade 3"];
    let atlas = ["clear", "light 1", "light 2", "light 3"];
    let maps = [&cascades[..], &atlas[..]];
    assert!(maps.iter().all(|map| passes.iter().any(|pass| pass == map)), "{passes:?}");
    let alone: Vec<_> = passes.iter().filter(|pass| pass.len() == 1).flatten().collect();
    assert_eq!(alone, [&"depth prepass", &"forward", &"tonemap"]);
    assert_eq!((counts.passes, passes.len()), (5, 5));
    assert_eq!(counts.uploads, uploads(&plan));
    assert!(counts.draws > 100, "{counts:?}");
}

#[test]
fn without_shadows_there_are_two_passes_fewer_on_both_sides() {
    let gpu = Gpu::noop().unwrap();
    let mut scene = demo_scene();
    let dark = |light: &Light| Light { casts_shadow: false, ..light.clone() };
    let lights: Vec<Light> = scene.lights().iter().map(dark).collect();
    scene.set_lights(lights);
    let camera = scene.cameras[0].clone();
    let options = options(&scene, &camera);
    let mut renderer = renderer(&gpu, scene, &camera, Aov::Color);
    let (plan, _) = renderer.plan(&options).unwrap();
    let counts = compare(&gpu, &mut renderer, &options, 1).unwrap().counts;
    assert_eq!((counts.passes, render_passes(&plan).len()), (3, 3));
}

#[test]
fn every_pair_is_measured_and_every_step_takes_time() {
    let gpu = Gpu::noop().unwrap();
    let (mut renderer, options) = demo(&gpu);
    let comparison = compare(&gpu, &mut renderer, &options, 12).unwrap();
    assert_eq!((comparison.graph.len(), comparison.hand_written.len()), (12, 12));
    for time in &comparison.graph {
        assert!(time.plan.is_zero() && !time.declare.is_zero() && !time.compile.is_zero(), "{time:?}");
    }
    for time in &comparison.hand_written {
        assert!(!time.plan.is_zero() && time.declare.is_zero() && !time.record.is_zero(), "{time:?}");
    }
    let (whole, graph_work) = (comparison.ratio(), comparison.ratio_without_planning());
    assert!(whole.median > 0.1 && graph_work.median.is_finite(), "{whole:?} {graph_work:?}");
}

#[test]
fn only_the_output_color_is_measured() {
    let gpu = Gpu::noop().unwrap();
    let (renderer, options) = demo(&gpu);
    let camera = options.camera.clone();
    let mut renderer = self::renderer(&gpu, renderer.scene().clone(), &camera, Aov::Normal);
    assert!(matches!(compare(&gpu, &mut renderer, &options, 1), Err(Error::BenchAov)));
}

#[test]
fn pass_times_list_every_pass_in_order() {
    let gpu = Gpu::noop().unwrap();
    let (mut renderer, options) = demo(&gpu);
    let times = pass_times(&gpu, &mut renderer, &options, 3).unwrap();
    let (plan, _) = renderer.plan(&options).unwrap();
    let paths: Vec<_> = plan.order().iter().map(|&id| plan.pass_path(id)).collect();
    assert_eq!(times.iter().map(|time| &time.pass).collect::<Vec<_>>(), paths.iter().collect::<Vec<_>>());
    // The clears of the maps have no body, so nothing is recorded.
    let bare = |time: &TimeSummary| time.pass.ends_with("/clear");
    assert_eq!(times.iter().filter(|time| bare(time)).count(), 2, "{times:?}");
    assert!(times.iter().all(|time| (time.cpu_ms.median > 0.0) != bare(time)), "{times:?}");
}

fn read(gpu: &Gpu, texture: &wgpu::Texture) -> RenderedImage {
    let size_px = [texture.width(), texture.height()];
    let mut frame = Frame::new();
    let texture = frame.import_texture("target", texture, true);
    let request = frame.read_back_texture(&texture, Subresource::FULL);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut executed =
        frame.compile().unwrap().execute(&mut Graph::new(), &gpu.device, &mut encoder).unwrap();
    gpu.queue.submit([encoder.finish()]);
    RenderedImage { size_px, rgba8: executed.read_back(request).unwrap().wait(&gpu.device).unwrap() }
}

/// Both sides draw the same, so the images are identical.
#[test]
fn the_hand_written_image_equals_that_of_the_graph() {
    let gpu = match Gpu::open(&AdapterChoice::Cpu) {
        Ok(gpu) => gpu,
        Err(error) => return skip("bench_images", &error.to_string()),
    };
    let (mut renderer, options) = demo(&gpu);
    let target = target(&gpu.device, options.size_px).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    renderer.record(&gpu, &mut encoder, &target, &options).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let of_graph = read(&gpu, &target);
    let other = super::target(&gpu.device, options.size_px).unwrap();
    let view = renderer.view(&options, Some(&other));
    HandWritten::new(&gpu, &renderer, &view, &other).unwrap().frame(&gpu).unwrap();
    let hand_written = read(&gpu, &other);
    assert_eq!(of_graph, hand_written);
    let mut colors: Vec<_> = of_graph.rgba8.chunks_exact(4).collect();
    colors.sort_unstable();
    colors.dedup();
    assert!(colors.len() > 100, "a image of {} colours", colors.len());
}

/// Reports a skip, as described in `CONTRIBUTING.md`.
#[allow(clippy::print_stdout, reason = "the line is for whoever runs the test")]
fn skip(id: &str, reason: &str) {
    let line = format!("SKIP {id}: {reason}\n");
    print!("{line}");
    if let Some(log) = std::env::var_os("SHADOWGRAPH_SKIP_LOG") {
        let mut log = std::fs::OpenOptions::new().append(true).create(true).open(log).unwrap();
        log.write_all(line.as_bytes()).unwrap();
    }
}

#[test]
fn whole_frames_take_at_least_the_processor_time_of_their_thread() {
    let gpu = Gpu::noop().unwrap();
    let (mut renderer, options) = demo(&gpu);
    let frames = whole_frames(&gpu, &mut renderer, &options, 5).unwrap();
    assert_eq!(frames.len(), 5);
    let slack = Duration::from_millis(1);
    assert!(frames.iter().all(|frame| !frame.thread.is_zero() && frame.thread <= frame.wall + slack));
}
