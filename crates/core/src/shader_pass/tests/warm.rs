//! Warming up pipelines.

use super::{Gpu, TEXT, cleared, fragment, kernel, texture, whole, words};
use crate::{Contents, Format, Frame, FullscreenShader, Resize, Subresource, TextureDesc};
use std::time::{Duration, Instant};

#[test]
fn a_warmed_up_frame_finds_its_pipelines_and_its_plan() {
    let mut gpu = Gpu::noop();
    let (shader, double) = (fragment("level"), kernel("double"));
    let frame = |gpu: &Gpu| {
        let mut frame = gpu.graph.frame();
        let mut image = texture(&mut frame, "image", 4, Format::Rgba8Unorm);
        frame.fullscreen("draw", &shader).draw(&mut image);
        let mut numbers = frame.upload_buffer("numbers", vec![0; 64]);
        frame.compute("double", &double).storage_mut(&mut numbers, Contents::Preserve).dispatch([1; 3]);
        frame.export_texture(&image);
        frame.export_buffer(&numbers);
        frame
    };
    let warm = frame(&gpu);
    gpu.graph.warm(warm, &gpu.device, &gpu.queue).unwrap();
    assert_eq!(gpu.cached(), (1, 1, 0), "pipelines only");
    assert_eq!(gpu.graph.bytes(), 0);
    let real = frame(&gpu);
    gpu.run(real).unwrap();
    assert_eq!((gpu.cached().0, gpu.cached().1), (1, 1));
    assert_eq!(gpu.graph.plan_counts().reused, 1);
}

#[test]
fn warming_up_later_keeps_existing_pipelines() {
    let mut gpu = Gpu::noop();
    let shader = fragment("level");
    let frame = |gpu: &Gpu, format| {
        let mut frame = gpu.graph.frame();
        let mut image = texture(&mut frame, "image", 4, format);
        frame.fullscreen("draw", &shader).draw(&mut image);
        frame.export_texture(&image);
        frame
    };
    for _ in 0..50 {
        let own = frame(&gpu, Format::Rgba8Unorm);
        gpu.run(own).unwrap();
    }
    let other = frame(&gpu, Format::Rgba16Float);
    gpu.graph.warm(other, &gpu.device, &gpu.queue).unwrap();
    assert_eq!(gpu.cached().0, 2);
    let own = frame(&gpu, Format::Rgba8Unorm);
    gpu.run(own).unwrap();
    assert_eq!(gpu.cached().0, 2, "created later, and not idle");
}

#[test]
fn a_frame_with_an_error_keeps_the_pipelines() {
    let mut gpu = Gpu::noop();
    let (good, bad) = (fragment("level"), fragment("wrong_type"));
    for shader in [&good, &bad] {
        let mut frame = gpu.graph.frame();
        let mut image = texture(&mut frame, "image", 4, Format::Rgba8Unorm);
        frame.fullscreen("draw", shader).draw(&mut image);
        frame.export_texture(&image);
        let warmed = gpu.graph.warm(frame, &gpu.device, &gpu.queue);
        assert_eq!(warmed.is_ok(), shader.0.name == "level");
    }
    assert_eq!(gpu.cached().0, 1);
}

#[test]
fn warming_up_changes_no_import_and_no_history() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 2, height: 2, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: Format::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let numbers = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 16,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let level = |level: f64| fragment("level").constant("LEVEL", level);
    let declare = |frame: &mut Frame<'_>, shader: &FullscreenShader| {
        let mut target = frame.import_texture("target", &target, true);
        frame.fullscreen("draw", shader).draw(&mut target);
        let mut own = frame.import_buffer("numbers", &numbers, true);
        frame.compute("double", &kernel("double")).storage_mut(&mut own, Contents::Preserve).dispatch([1; 3]);
        let mut history = frame.history("past", TextureDesc::d2(2, 2, Format::Rgba8Unorm), Resize::Reset);
        let valid = history.valid;
        frame.fullscreen("now", shader).draw(&mut history.current);
        (whole(frame, &history.previous), valid)
    };
    let mut frame = gpu.graph.frame();
    declare(&mut frame, &level(0.2));
    gpu.run(frame).unwrap();
    let mut frame = gpu.graph.frame();
    declare(&mut frame, &level(0.4));
    gpu.graph.warm(frame, &gpu.device, &gpu.queue).unwrap();

    let mut frame = gpu.graph.frame();
    let (read, valid) = declare(&mut frame, &level(0.6));
    assert!(valid);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut before = Frame::new();
    let imported = before.import_texture("target", &target, true);
    let target_read = whole(&mut before, &imported);
    let compiled = before.compile().unwrap();
    let mut own = compiled.execute(&mut crate::Graph::new(), &gpu.device, &mut encoder).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let held = own.read_back(target_read).unwrap().wait(&gpu.device).unwrap();
    assert_eq!(held, [51; 16], "drawn by the first frame");
    assert_eq!(gpu.bytes(frame, [read]), [[51; 16]], "left by the first frame");
}

/// Returns a shader that no driver has cached on disk.
fn unseen(name: &'static str, entry: &'static str, salt: u128) -> FullscreenShader {
    let text = TEXT.replace("vec4f(uv, 0.0, 1.0)", &format!("vec4f(uv, uv.x * {salt}e-20, 1.0)"));
    FullscreenShader::wgsl(name, text).entry_point(entry)
}

/// Runs a chain of passes with different shaders; returns the time from declaration to completion on the GPU.
fn timed(gpu: &mut Gpu, shaders: &[FullscreenShader]) -> Duration {
    let start = Instant::now();
    let mut frame = gpu.graph.frame();
    let mut image = cleared(&mut frame, "image", 32, 0.0);
    for shader in shaders {
        frame.fullscreen(&*shader.0.name, shader).draw_over(&mut image, wgpu::BlendState::ALPHA_BLENDING);
    }
    let read = frame.read_back_texture(&image, Subresource::FULL);
    let [texels] = gpu.bytes(frame, [read]);
    assert_eq!(words(&texels).len(), 32 * 32);
    start.elapsed()
}

fn shaders(salt: u128) -> Vec<FullscreenShader> {
    (0..4).map(|i| unseen("gradient", "gradient", salt + i)).collect()
}

/// Prints times with `--nocapture`; it asserts little, since machines differ.
#[test]
fn the_first_frame_after_warming_up_is_not_slow() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let salt = std::time::UNIX_EPOCH.elapsed().unwrap().as_nanos() % 8_000_000;
    let median = |mut times: Vec<Duration>| {
        times.sort();
        times[times.len() / 2]
    };
    let (mut cold, mut warm, mut warming, mut later) = (vec![], vec![], vec![], vec![]);
    for round in 0..5 {
        let unwarmed = shaders(salt + 100 * round);
        cold.push(timed(&mut gpu, &unwarmed));
        let warmed = shaders(salt + 100 * round + 50);
        let mut frame = gpu.graph.frame();
        let mut image = cleared(&mut frame, "image", 8, 0.0);
        for shader in &warmed {
            frame.fullscreen(&*shader.0.name, shader).draw_over(&mut image, wgpu::BlendState::ALPHA_BLENDING);
        }
        frame.export_texture(&image);
        let start = Instant::now();
        gpu.graph.warm(frame, &gpu.device, &gpu.queue).unwrap();
        warming.push(start.elapsed());
        warm.push(timed(&mut gpu, &warmed));
        later.extend((0..5).map(|_| timed(&mut gpu, &warmed)));
    }
    let (cold, warm, warming, later) = (median(cold), median(warm), median(warming), median(later));
    println!(
        "first frame {cold:.1?} cold, {warm:.1?} after warming ({warming:.1?}), later frames {later:.1?}"
    );
    assert!(warm < cold, "{warm:?} after warming, {cold:?} without");
}
