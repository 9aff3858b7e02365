//! What is made, and how often.

use super::{Gpu, TEXT, cleared, fragment, kernel, texture};
use crate::{Contents, Error, Executed, Format, Frame, FullscreenShader};

/// A frame that draws `shader` into a picture of each format.
fn draws<'f>(gpu: &Gpu, shader: &FullscreenShader, formats: &[Format]) -> Frame<'f> {
    let mut frame = gpu.graph.frame();
    for &format in formats {
        let mut picture = texture(&mut frame, "picture", 4, format);
        frame.fullscreen("draw", shader).draw(&mut picture);
        frame.export_texture(&picture);
    }
    frame
}

/// A frame that scales a picture of this side.
fn scales(
    gpu: &mut Gpu,
    shader: &FullscreenShader,
    nearest: &wgpu::Sampler,
    side: u32,
) -> Result<Executed, Error> {
    let mut frame = gpu.graph.frame();
    let source = cleared(&mut frame, "source", side, 1.0);
    let mut picture = texture(&mut frame, "picture", side, Format::Rgba8Unorm);
    frame.fullscreen("scale", shader).sample(&source).sampler(nearest).uniform(&[0; 16]).draw(&mut picture);
    frame.export_texture(&picture);
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
fn what_a_pipeline_is_made_of_tells_it_from_others() {
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
    let mut picture = cleared(&mut frame, "picture", 4, 0.0);
    frame.fullscreen("over", &shaders[0]).draw_over(&mut picture, wgpu::BlendState::ALPHA_BLENDING);
    frame.export_texture(&picture);
    gpu.run(frame).unwrap();
    assert_eq!(gpu.cached().0, 6, "a blend");
}

#[test]
fn pipelines_stay_while_their_shader_does() {
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
    assert_eq!(gpu.cached().0, 1, "the one that is left is that of the shader that is left");
}

#[test]
fn shaders_made_anew_in_each_frame_find_their_pipeline() {
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
fn bind_groups_are_made_exactly_when_a_slot_changes() {
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
    assert_eq!(groups(&mut gpu, 64), 2, "the old size is still there");
    for _ in 0..10 {
        groups(&mut gpu, 64);
    }
    assert_eq!(groups(&mut gpu, 64), 1, "what lies idle goes");
    let pipelines = gpu.cached().0;
    assert_eq!(pipelines, 1, "sizes make no pipelines");
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
fn frames_declare_shader_passes_in_the_memory_of_frames_before() {
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
