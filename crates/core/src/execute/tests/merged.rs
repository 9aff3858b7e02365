//! Passes that share one render pass: each starts from clean state.

use super::gpu::{Gpu, NUMBERS, depth_test, number, square};
use crate::test_device::block_on;
use crate::{Bind, Contents, Format, Graph, TextureDesc};

#[test]
fn a_pass_that_draws_with_the_bind_group_of_an_earlier_one_is_an_error() {
    for gpu in Gpu::all() {
        let draw = gpu.draw("number", NUMBERS);
        for sets_its_own in [true, false] {
            let mut graph = Graph::new();
            let mut frame = graph.frame();
            let block = frame.uniform(&number(4));
            let mut color = frame.create_texture("color", square(8));
            let mut first = frame.render_pass("first");
            first.color(&mut color, Contents::Overwrite);
            first.body(|ctx| draw.record(ctx, &[Bind::Uniform(block)]));
            let mut second = frame.render_pass("second");
            second.color(&mut color, Contents::Preserve);
            second.body(|ctx| match sets_its_own {
                true => draw.record(ctx, &[Bind::Uniform(block)]),
                false => {
                    draw.record_without_bindings(ctx);
                    Ok(())
                }
            });
            frame.export_texture(&color);
            let compiled = graph.compile(frame).unwrap();
            assert_eq!(compiled.plan().steps().len(), 1, "they are merged");
            let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
            let mut encoder = gpu.encoder();
            compiled.execute(&mut graph, &gpu.device, &mut encoder).unwrap();
            drop(encoder.finish());
            let error = block_on(scope.pop());
            assert_eq!(error.is_none(), sets_its_own, "{error:?}");
        }
    }
}

#[test]
fn groups_beyond_the_default_limit_are_unset_too() {
    let required_limits = wgpu::Limits { max_bind_groups: 6, ..Default::default() };
    let desc = wgpu::DeviceDescriptor { required_limits, ..Default::default() };
    let gpu = Gpu::new(wgpu::Device::noop(&desc), false);
    let draw = gpu.draw_with_far_group();
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let block = frame.uniform(&number(4));
    let mut color = frame.create_texture("color", square(8));
    let mut first = frame.render_pass("first");
    first.color(&mut color, Contents::Overwrite);
    first.body(|ctx| draw.record(ctx, &[Bind::Uniform(block)]));
    let mut second = frame.render_pass("second");
    second.color(&mut color, Contents::Preserve);
    second.body(|ctx| {
        draw.record_without_bindings(ctx);
        Ok(())
    });
    frame.export_texture(&color);
    let compiled = graph.compile(frame).unwrap();
    let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
    let mut encoder = gpu.encoder();
    compiled.execute(&mut graph, &gpu.device, &mut encoder).unwrap();
    drop(encoder.finish());
    let error = block_on(scope.pop()).unwrap().to_string();
    assert!(error.contains("index 5"), "{error}");
}

/// Runs one pass that leaves all of its state changed, and a second one that draws white.
fn after_a_messy_pass(gpu: &Gpu, second: &super::Draw) -> Vec<u32> {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let desc = |format| TextureDesc::d2(8, 8, format);
    let mut color = frame.create_texture("color", desc(Format::Rgba8Unorm));
    let mut depth = frame.create_texture("depth", desc(Format::Depth24PlusStencil8));
    let mut pass = frame.render_pass("messy");
    pass.color(&mut color, Contents::clear_color([0.0; 4]));
    pass.depth(&mut depth, Contents::clear_depth_stencil(0.0, 0));
    pass.body(|ctx| {
        ctx.pass.set_viewport(1.0, 1.0, 2.0, 2.0, 0.0, 0.1);
        ctx.pass.set_scissor_rect(1, 1, 2, 2);
        ctx.pass.set_stencil_reference(3);
        ctx.pass.set_blend_constant(wgpu::Color::WHITE);
        Ok(())
    });
    let mut pass = frame.render_pass("tidy");
    pass.color(&mut color, Contents::Preserve);
    pass.depth(&mut depth, Contents::Preserve);
    pass.body(|ctx| {
        second.record_without_bindings(ctx);
        Ok(())
    });
    let color = frame.export_texture(&color);
    let executed = gpu.run(&mut graph, frame);
    assert_eq!(executed.plan().steps().len(), 1);
    gpu.texels(executed.texture(color).unwrap(), 0, 0)
}

#[test]
fn viewport_scissor_stencil_reference_and_blend_constant_are_those_of_a_new_pass() {
    for gpu in Gpu::all() {
        state_is_that_of_a_new_pass(&gpu);
    }
}

fn state_is_that_of_a_new_pass(gpu: &Gpu) {
    let filled = |texels: Vec<u32>, with| !gpu.draws || texels == [with; 64];
    let format = Format::Depth24PlusStencil8;
    let mut depth = depth_test(format, wgpu::CompareFunction::GreaterEqual, true);
    let plain = gpu.draw_with("white", Format::Rgba8Unorm.into(), Some(depth.clone()), 1);
    assert!(filled(after_a_messy_pass(gpu, &plain), u32::MAX), "viewport and scissor");
    let face =
        wgpu::StencilFaceState { compare: wgpu::CompareFunction::Equal, ..wgpu::StencilFaceState::IGNORE };
    depth.stencil = wgpu::StencilState { front: face, back: face, read_mask: 255, write_mask: 0 };
    let stencilled = gpu.draw_with("white", Format::Rgba8Unorm.into(), Some(depth.clone()), 1);
    assert!(filled(after_a_messy_pass(gpu, &stencilled), u32::MAX), "stencil reference");
    depth.stencil = Default::default();
    let by_constant = wgpu::BlendComponent {
        src_factor: wgpu::BlendFactor::Constant,
        dst_factor: wgpu::BlendFactor::Zero,
        operation: wgpu::BlendOperation::Add,
    };
    let blended = wgpu::ColorTargetState {
        blend: Some(wgpu::BlendState { color: by_constant, alpha: by_constant }),
        ..Format::Rgba8Unorm.into()
    };
    let blended = gpu.draw_with("white", blended, Some(depth), 1);
    assert!(filled(after_a_messy_pass(gpu, &blended), 0), "blend constant");
}

#[test]
fn merged_passes_are_one_render_pass_of_the_encoder() {
    // The depth never leaves the step, so it is a transient attachment, which wgpu allows neither to be loaded nor to
    // be stored: two render passes would be an error.
    for gpu in Gpu::all() {
        let format = Format::Depth32Float;
        let near = depth_test(format, wgpu::CompareFunction::Greater, true);
        let equal = depth_test(format, wgpu::CompareFunction::Equal, false);
        let first = gpu.draw_with("seven", NUMBERS.into(), Some(near), 1);
        let second = gpu.draw_with("number", NUMBERS.into(), Some(equal), 1);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let block = frame.uniform(&number(9));
        let mut color = frame.create_texture("color", square(8));
        let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, format));
        let mut pass = frame.render_pass("first");
        pass.color(&mut color, Contents::clear_color([1.0, 0.0, 0.0, 0.0]));
        pass.depth(&mut depth, Contents::clear_depth(0.0));
        pass.body(|ctx| {
            ctx.pass.set_scissor_rect(0, 0, 4, 8);
            first.record_without_bindings(ctx);
            Ok(())
        });
        let mut pass = frame.render_pass("second");
        pass.color(&mut color, Contents::Preserve);
        pass.depth(&mut depth, Contents::Preserve);
        pass.body(|ctx| second.record(ctx, &[Bind::Uniform(block)]));
        let color = frame.export_texture(&color);
        let executed = gpu.run(&mut graph, frame);
        let usage = executed.plan().resource(depth.id()).texture_usage;
        assert!(usage.contains(wgpu::TextureUsages::TRANSIENT_ATTACHMENT));
        if gpu.draws {
            let texels = gpu.texels(executed.texture(color).unwrap(), 0, 0);
            assert_eq!(texels[..8], [9, 9, 9, 9, 1, 1, 1, 1], "the second drew where the first did");
        }
    }
}
