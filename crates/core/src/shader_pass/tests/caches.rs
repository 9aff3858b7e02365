//! Tests that pipelines and bind groups are created as rarely as possible.

use super::{Gpu, TEXT, cleared, fragment, kernel, texture};
use crate::{Contents, Error, Executed, Format, Frame, FullscreenShader};

/// Runs a frame that draws `shader` into a texture of each format.
fn draws<'f>(gpu: &Gpu, shader: &FullscreenShader, formats: &[Format]) -> Frame<'f> {
    let mut frame = gpu.graph.frame();
    for &format in formats {
        let mut image = texture(&mut frame, "image", 4, format);
        frame.fullscreen("draw", shader).draw(&mut image);
        frame.export_texture(&image);
    }
    frame
}

/// Runs a frame that scales a texture of this size.
fn scales(
    gpu: &mut Gpu,
    shader: &FullscreenShader,
    nearest: &wgpu::Sampler,
    side: u32,
) -> Result<Executed, Error> {
    let mut frame = gpu.graph.frame();
    let source = cleared(&mut frame, "source", side, 1.0);
    let mut image = texture(&mut frame, "image", side, Format::Rgba8Unorm);
    frame.fullscreen("scale", shader).sample(&source).sampler(nearest).uniform(&[0; 16]).draw(&mut image);
    frame.export_texture(&image);
    gpu.run(frame)
}

#[test]
fn equal_shaders_share_a_pipeline() {
    let mut gpu = Gpu::noop();
    for name in ["one", "other"] {
        let shader = FullscreenShader::wgsl(name, TEXT.to_owned()).entry_point("gradient");
        let frame = draws(&gpu, &shader, &[Format::Rgba8Unorm, Format::Rgba8Unorm]);
        gpu.run(frame).unwrap();
        assert_eq!(gpu.cached().0, 1);
    }
}

#[test]
fn pipelines_differ_by_source_entry_point_constants_and_targets() {
    let mut gpu = Gpu::noop();
    let shaders = [
        fragment("level"),
        fragment("gradient"),
        fragment("level").constant("LEVEL", 0.5),
        fragment("level").constant("LEVEL", 0.25),
    ];
    for (count, shader) in (1..).zip(&shaders) {
        let frame = draws(&gpu, shader, &[Format::Rgba8Unorm]);
        gpu.run(frame).unwrap();
        assert_eq!(gpu.cached().0, count);
    }
    let frame = draws(&gpu, &shaders[0], &[Format::Rgba8Unorm, Format::Rgba16Float]);
    gpu.run(frame).unwrap();
    assert_eq!(gpu.cached().0, 5, "another format");
    let mut frame = gpu.graph.frame();
    let mut image = cleared(&mut frame, "image", 4, 0.0);
    frame.fullscreen("over", &shaders[0]).draw_over(&mut image, wgpu::BlendState::ALPHA_BLENDING);
    frame.export_texture(&image);
    gpu.run(frame).unwrap();
    assert_eq!(gpu.cached().0, 6, "a blend");
}

#[test]
fn pipelines_are_kept_while_their_shader_is() {
    let mut gpu = Gpu::noop();
    let (kept, dropped) = (fragment("level"), fragment("gradient"));
    for shader in [&kept, &dropped] {
        let frame = draws(&gpu, shader, &[Format::Rgba8Unorm]);
        gpu.run(frame).unwrap();
    }
    drop(dropped);
    for _ in 0..20 {
        let frame = gpu.graph.frame();
        gpu.run(frame).unwrap();
    }
    assert_eq!(gpu.cached().0, 1);
    let frame = draws(&gpu, &kept, &[Format::Rgba8Unorm]);
    gpu.run(frame).unwrap();
    assert_eq!(gpu.cached().0, 1, "the remaining pipeline is that of the remaining shader");
}

#[test]
fn shaders_created_in_each_frame_find_their_pipeline() {
    let mut gpu = Gpu::noop();
    for _ in 0..30 {
        let mut frame = gpu.graph.frame();
        let mut numbers = frame.upload_buffer("numbers", vec![0; 64]);
        frame
            .compute("double", &kernel("double"))
            .storage_mut(&mut numbers, Contents::Preserve)
            .dispatch([1; 3]);
        frame.export_buffer(&numbers);
        gpu.run(frame).unwrap();
        assert_eq!(gpu.cached(), (0, 1, 1));
    }
}

#[test]
fn bind_groups_are_created_only_when_a_slot_changes() {
    let mut gpu = Gpu::noop();
    let nearest = gpu.device.create_sampler(&wgpu::SamplerDescriptor::default());
    let scaled = fragment("scaled");
    let groups = |gpu: &mut Gpu, side: u32| {
        scales(gpu, &scaled, &nearest, side).unwrap();
        gpu.cached().2
    };
    for _ in 0..20 {
        assert_eq!(groups(&mut gpu, 64), 1, "an unchanged frame");
    }
    assert_eq!(groups(&mut gpu, 128), 2, "another size is another slot");
    assert_eq!(groups(&mut gpu, 64), 2, "the old size is still cached");
    for _ in 0..10 {
        groups(&mut gpu, 64);
    }
    assert_eq!(groups(&mut gpu, 64), 1, "idle groups are dropped");
    let pipelines = gpu.cached().0;
    assert_eq!(pipelines, 1, "sizes need no new pipelines");
}

#[test]
fn a_buffer_with_the_same_slot_keeps_its_group_and_another_sampler_gets_one() {
    let mut gpu = Gpu::noop();
    let scaled = fragment("scaled");
    let samplers = [(), ()].map(|()| gpu.device.create_sampler(&wgpu::SamplerDescriptor::default()));
    for _ in 0..3 {
        for sampler in &samplers {
            scales(&mut gpu, &scaled, sampler, 64).unwrap();
        }
    }
    assert_eq!(gpu.cached().2, 2);
}

#[test]
fn frames_declare_shader_passes_in_the_memory_of_earlier_frames() {
    let mut gpu = Gpu::noop();
    let shader = fragment("level");
    let formats = [Format::Rgba8Unorm; 20];
    let mut addresses = Vec::new();
    for _ in 0..10 {
        let frame = draws(&gpu, &shader, &formats);
        addresses.push(frame.work.shader_passes.address());
        gpu.run(frame).unwrap();
    }
    assert!(addresses[2..].iter().all(|address| *address == addresses[2]), "{addresses:?}");
}
