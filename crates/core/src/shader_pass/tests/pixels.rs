//! Output of one-line draws, texel by texel.

use super::{Gpu, cleared, fragment, texture, whole, words};
use crate::{
    ClearValue, Contents, Format, FullscreenShader, Graph, MergeReason, Rect, Subresource, TextureDesc,
};
use wgpu::BlendState;

const ADD: BlendState = {
    let add = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::One,
        dst_factor: wgpu::BlendFactor::One,
        operation: wgpu::BlendOperation::Add,
    };
    BlendState { color: add, alpha: add }
};

/// Returns the texels of the gradient on a square: uv in red and green, in 8 bits.
fn gradient(side: u32) -> Vec<u8> {
    let level = |at: u32| ((at as f32 + 0.5) / side as f32 * 255.0).round() as u8;
    (0..side * side).flat_map(|i| [level(i % side), level(i / side), 0, 255]).collect()
}

#[test]
fn uv_begins_at_the_upper_left_corner() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut image = texture(&mut frame, "image", 4, Format::Rgba8Unorm);
    frame.fullscreen("gradient", &fragment("gradient")).draw(&mut image);
    let read = whole(&mut frame, &image);
    assert_eq!(gpu.bytes(frame, [read]), [gradient(4)]);
}

#[test]
fn a_module_draws_like_its_source() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(super::TEXT.into()),
    });
    let mut frame = gpu.graph.frame();
    let mut image = texture(&mut frame, "image", 4, Format::Rgba8Unorm);
    frame
        .fullscreen("gradient", &FullscreenShader::module("own", &module).entry_point("gradient"))
        .draw(&mut image);
    let read = whole(&mut frame, &image);
    assert_eq!(gpu.bytes(frame, [read]), [gradient(4)]);
}

#[test]
fn a_constant_changes_the_output() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let reads = [fragment("level"), fragment("level").constant("LEVEL", 0.6)].map(|shader| {
        let mut image = texture(&mut frame, "image", 2, Format::Rgba8Unorm);
        frame.fullscreen("level", &shader).draw(&mut image);
        whole(&mut frame, &image)
    });
    assert_eq!(gpu.bytes(frame, reads), [vec![51; 16], vec![153; 16]]);
}

#[test]
fn drawing_over_blends_with_the_contents() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let level = fragment("level").constant("LEVEL", 0.4);
    for (blend, expected) in [(Some(ADD), 51 + 102), (None, 102), (Some(BlendState::REPLACE), 102)] {
        let mut frame = gpu.graph.frame();
        let mut image = cleared(&mut frame, "image", 3, 0.2);
        frame.fullscreen("over", &level).draw_over(&mut image, blend);
        let read = whole(&mut frame, &image);
        assert_eq!(gpu.bytes(frame, [read]), [vec![expected; 36]], "{blend:?}");
    }
}

#[test]
fn drawing_over_keeps_texels_that_the_shader_discards() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut image = cleared(&mut frame, "image", 2, 0.2);
    frame.fullscreen("half", &fragment("right_half")).draw_over(&mut image, None);
    let read = whole(&mut frame, &image);
    let row = [[51; 4], [255; 4]].concat();
    assert_eq!(gpu.bytes(frame, [read]), [row.repeat(2)]);
}

#[test]
fn a_tile_is_overwritten_and_the_rest_is_kept() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut image = cleared(&mut frame, "image", 4, 0.2);
    let tile = Subresource::FULL.rect(Rect::new(2, 1, 2, 2));
    frame.fullscreen("tile", &fragment("gradient")).subresource(tile).draw(&mut image);
    let read = whole(&mut frame, &image);
    let mut expected = vec![51; 64];
    for (row, texels) in gradient(2).chunks(8).enumerate() {
        let start = ((row + 1) * 4 + 2) * 4;
        expected[start..start + 8].copy_from_slice(texels);
    }
    assert_eq!(gpu.bytes(frame, [read]), [expected]);
}

#[test]
fn draws_into_tiles_of_one_target_share_a_render_pass() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut image = texture(&mut frame, "image", 4, Format::Rgba8Unorm);
    let shaders = [0.2, 0.4].map(|level| fragment("level").constant("LEVEL", level));
    for (x, shader) in [0, 2].into_iter().zip(&shaders) {
        let tile = Subresource::FULL.rect(Rect::new(x, 0, 2, 4));
        frame.fullscreen(format_args!("tile {x}"), shader).subresource(tile).draw(&mut image);
    }
    let read = whole(&mut frame, &image);
    let mut executed = gpu.run(frame).unwrap();
    let plan = executed.plan();
    assert_eq!(plan.merge_reasons, [MergeReason::First, MergeReason::Merged]);
    let texels = executed.read_back(read).unwrap().wait(&gpu.device).unwrap();
    assert_eq!(texels, [[51; 8], [102; 8]].concat().repeat(4));
}

#[test]
fn two_targets_of_different_formats_are_drawn_at_once() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut first = texture(&mut frame, "first", 2, Format::Rgba8Unorm);
    let mut second = texture(&mut frame, "second", 2, Format::Rgba32Uint);
    frame.fullscreen("two", &fragment("two")).target(&mut first).draw(&mut second);
    let reads = [whole(&mut frame, &first), whole(&mut frame, &second)];
    let [first, second] = gpu.bytes(frame, reads);
    assert_eq!(first, [51, 102, 153, 204].repeat(4));
    assert_eq!(words(&second), [0, 0, 7, 9, 1, 0, 7, 9, 0, 1, 7, 9, 1, 1, 7, 9]);
}

#[test]
fn one_target_is_preserved_while_the_other_is_overwritten() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut first = cleared(&mut frame, "first", 2, 0.2);
    let mut second = texture(&mut frame, "second", 2, Format::Rgba32Uint);
    frame.fullscreen("two", &fragment("two")).target_over(&mut first, ADD).draw(&mut second);
    let read = whole(&mut frame, &first);
    frame.export_texture(&second);
    assert_eq!(gpu.bytes(frame, [read]), [[102, 153, 204, 255].repeat(4)]);
}

#[test]
fn a_mip_level_is_drawn_from_the_previous_one() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let desc = TextureDesc { mip_levels: 3, ..TextureDesc::d2(8, 8, Format::Rgba8Unorm) };
    let mut chain = frame.create_texture("chain", desc);
    let mip = |level| Subresource::FULL.mip(level);
    frame.fullscreen("gradient", &fragment("gradient")).subresource(mip(0)).draw(&mut chain);
    for level in 1..3 {
        let before = chain.clone();
        frame
            .fullscreen("halve", &fragment("halve"))
            .subresource(mip(level - 1))
            .sample(&before)
            .subresource(mip(level))
            .draw(&mut chain);
    }
    let read = frame.read_back_texture(&chain, mip(2));
    let full = gradient(8);
    let texel = |x: usize, y: usize| full[(y * 8 + x) * 4..][..4].to_vec();
    let expected = [texel(0, 0), texel(4, 0), texel(0, 4), texel(4, 4)].concat();
    assert_eq!(gpu.bytes(frame, [read]), [expected]);
}

#[test]
fn depth_is_drawn_and_tested_against() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    for format in [Format::Depth32Float, Format::Depth24PlusStencil8] {
        let mut frame = gpu.graph.frame();
        let mut depth = texture(&mut frame, "depth", 2, format);
        if format.has_stencil_aspect() {
            frame.render_pass("stencil").depth(&mut depth, Contents::Clear(ClearValue::DepthStencil(1.0, 3)));
        }
        frame.fullscreen("depth", &fragment("depth_of_uv")).draw_depth(&mut depth);
        let mut image = cleared(&mut frame, "image", 2, 0.2);
        frame
            .fullscreen("sky", &fragment("level").constant("LEVEL", 1.0))
            .depth_test(&depth, wgpu::CompareFunction::Equal)
            .draw_over(&mut image, None);
        let read = whole(&mut frame, &image);
        let row = [[51; 4], [255; 4]].concat();
        assert_eq!(gpu.bytes(frame, [read]), [row.repeat(2)], "{format:?}");
    }
}

#[test]
fn multisampled_targets_are_drawn_into() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let desc = TextureDesc { samples: 4, ..TextureDesc::d2(2, 2, Format::Rgba8Unorm) };
    let mut many = frame.create_texture("many", desc);
    frame.fullscreen("level", &fragment("level")).draw(&mut many);
    let mut image = texture(&mut frame, "image", 2, Format::Rgba8Unorm);
    let mut resolve = frame.render_pass("resolve");
    resolve.color(&mut many, Contents::Preserve);
    resolve.resolve(&mut image);
    let read = whole(&mut frame, &image);
    assert_eq!(gpu.bytes(frame, [read]), [vec![51; 16]]);
}

#[test]
fn frames_in_flight_draw_with_their_own_uniforms() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let nearest = gpu.device.create_sampler(&wgpu::SamplerDescriptor::default());
    let scaled = fragment("scaled");
    let record = |gpu: &mut Gpu, factor: f32| {
        let mut frame = gpu.graph.frame();
        let source = cleared(&mut frame, "source", 2, 0.2);
        let mut image = texture(&mut frame, "image", 2, Format::Rgba8Unorm);
        let factor = [factor; 4].map(f32::to_le_bytes).concat();
        frame
            .fullscreen("scale", &scaled)
            .sample(&source)
            .sampler(&nearest)
            .uniform(&factor)
            .draw(&mut image);
        let read = whole(&mut frame, &image);
        let (mut executed, encoder) = gpu.record(frame).unwrap();
        (executed.read_back(read).unwrap(), encoder)
    };
    for _ in 0..3 {
        let (first, first_encoder) = record(&mut gpu, 2.0);
        let (second, second_encoder) = record(&mut gpu, 4.0);
        gpu.queue.submit([second_encoder.finish()]);
        gpu.queue.submit([first_encoder.finish()]);
        assert_eq!(first.wait(&gpu.device).unwrap(), [102; 16]);
        assert_eq!(second.wait(&gpu.device).unwrap(), [204; 16]);
    }
    assert_eq!(gpu.cached(), (1, 0, 1), "one pipeline and one bind group for all frames");
}

#[test]
fn several_passes_share_a_uniform_block() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let nearest = gpu.device.create_sampler(&wgpu::SamplerDescriptor::default());
    let mut frame = gpu.graph.frame();
    let factor = frame.uniform(&[2.0f32; 4].map(f32::to_le_bytes).concat());
    let mut before = cleared(&mut frame, "image 0", 2, 0.2);
    for pass in 1..3 {
        let mut image = texture(&mut frame, "image", 2, Format::Rgba8Unorm);
        let scale = frame.fullscreen(format_args!("scale {pass}"), &fragment("scaled"));
        scale.sample(&before).sampler(&nearest).uniform(factor).draw(&mut image);
        before = image;
    }
    let read = whole(&mut frame, &before);
    assert_eq!(gpu.bytes(frame, [read]), [[204; 16]]);
}

#[test]
fn threads_record_one_line_passes_and_read_backs() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    for threads in [1, 3] {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let reads: Vec<_> = (1..=5)
            .map(|step| {
                let level = fragment("level").constant("LEVEL", f64::from(step) * 0.2);
                let mut image = texture(&mut frame, "image", 2, Format::Rgba8Unorm);
                frame.fullscreen(format_args!("level {step}"), &level).draw(&mut image);
                whole(&mut frame, &image)
            })
            .collect();
        let compiled = graph.compile(frame).unwrap();
        let (mut executed, commands) = compiled.execute_on_threads(&mut graph, &gpu.device, threads).unwrap();
        gpu.queue.submit(commands);
        for (step, read) in (1..).zip(reads) {
            let texels = executed.read_back(read).unwrap().wait(&gpu.device).unwrap();
            assert_eq!(texels, [51 * step; 16]);
        }
    }
    let _ = &mut gpu;
}
