//! Whole frames of many kinds of passes, and their results.

use super::gpu::{Gpu, NUMBERS, number, square};
use crate::{Bind, BufferDesc, Contents, Error, Format, Frame, Graph, TextureDesc};
use std::sync::atomic::{AtomicU32, Ordering};

#[test]
fn a_frame_of_every_kind_of_pass_records_without_validation_errors() {
    for gpu in Gpu::all() {
        let (draw, copy) = (gpu.draw("number", NUMBERS), gpu.compute("copy_words"));
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let numbers = frame.upload_buffer("numbers", &[1u8, 0, 0, 0, 2][..]);
        let mut sums = frame.create_buffer("sums", BufferDesc::new(8));
        let mut pass = frame.compute_pass("sum");
        let (from, to) =
            (pass.storage_buffer(&numbers), pass.storage_buffer_mut(&mut sums, Contents::Overwrite));
        pass.body(move |ctx| copy.record(ctx, &[Bind::Buffer(from), Bind::Buffer(to)], 1));
        let block = frame.uniform(&number(5));
        let mut color = frame.create_texture("color", square(16));
        let mut pass = frame.render_pass("draw");
        pass.color(&mut color, Contents::Overwrite);
        pass.body(move |ctx| draw.record(ctx, &[Bind::Uniform(block)]));
        let mut copied = frame.create_texture("copied", square(16));
        frame.copy_pass("copy").texture(&color, &mut copied);
        let mut rows = frame.create_buffer("rows", BufferDesc::new(256 * 16));
        frame.copy_pass("to rows").texture_to_buffer(&copied, &mut rows);
        let mut pass = frame.encoder_pass("raw");
        let from = pass.copy_source_buffer(&sums);
        let to = pass
            .subresource(crate::Subresource::FULL.bytes(64..72))
            .copy_target_buffer(&mut rows, Contents::Overwrite);
        pass.body(move |ctx| {
            let (from, to) = (ctx.buffer(from)?, ctx.buffer(to)?);
            ctx.encoder.copy_buffer_to_buffer(from, 0, to, 64, 8);
            Ok(())
        });
        let (sums, rows) = (frame.export_buffer(&sums), frame.export_buffer(&rows));
        let executed = gpu.run(&mut graph, frame);
        assert_eq!(executed.plan().order().len(), 6);
        if gpu.draws {
            assert_eq!(gpu.words(executed.buffer(sums).unwrap()), [2001, 2002]);
            let rows = gpu.words(executed.buffer(rows).unwrap());
            assert_eq!(rows[..16], [5; 16]);
            assert_eq!(rows[16..18], [2001, 2002], "written between the rows, over their padding");
            assert_eq!(rows[64..80], [5; 16]);
        }
    }
}

#[test]
fn an_empty_frame_records_nothing() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let frame = graph.frame();
        assert_eq!(gpu.run(&mut graph, frame).plan().order().len(), 0);
    }
}

#[test]
fn the_body_of_a_culled_pass_does_not_run() {
    let gpu = Gpu::noop();
    let (mut graph, ran) = (Graph::new(), AtomicU32::new(0));
    let mut frame = graph.frame();
    let mut unread = frame.create_texture("unread", square(8));
    let mut kept = frame.create_texture("kept", square(8));
    for (name, target) in [("unread", &mut unread), ("kept", &mut kept)] {
        let mut pass = frame.render_pass(name);
        pass.color(target, Contents::clear_color([0.0; 4]));
        pass.body(|_| {
            ran.fetch_add(1, Ordering::Relaxed);
            Ok(())
        });
    }
    frame.export_texture(&kept);
    gpu.run(&mut graph, frame);
    assert_eq!(ran.load(Ordering::Relaxed), 1);
}

#[test]
fn an_export_belongs_to_its_own_frame_only() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let mut exports = Vec::new();
    let mut executed = Vec::new();
    for _ in 0..2 {
        let mut frame = graph.frame();
        let mut own = frame.create_texture("own", TextureDesc::d2(4, 4, Format::R8Unorm));
        frame.render_pass("own").color(&mut own, Contents::clear_color([1.0; 4]));
        let mut words = frame.create_buffer("words", BufferDesc::new(12));
        let mut pass = frame.compute_pass("words");
        pass.storage_buffer_mut(&mut words, Contents::Overwrite);
        exports.push((frame.export_texture(&own), frame.export_buffer(&words)));
        executed.push(gpu.run(&mut graph, frame));
    }
    let [(texture, buffer), (next, _)] = exports[..] else { unreachable!() };
    assert_eq!(executed[0].texture(texture).unwrap().width(), 4);
    assert_eq!(executed[0].buffer(buffer).unwrap().size(), 12, "has the requested size");
    assert!(executed[0].texture(next).is_none());
}

#[test]
fn a_token_of_a_part_resolves_to_that_part() {
    for gpu in Gpu::all() {
        let copy = gpu.compute("copy_words");
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let bytes: Vec<u8> = (0..128u32).flat_map(u32::to_le_bytes).collect();
        let numbers = frame.upload_buffer("numbers", bytes);
        let mut out = frame.create_buffer("out", BufferDesc::new(512));
        for (name, from, to) in [("back", 256..512, 0..256), ("front", 0..16, 256..512)] {
            let mut pass = frame.compute_pass(name);
            let from = pass.subresource(crate::Subresource::FULL.bytes(from)).storage_buffer(&numbers);
            let to = pass
                .subresource(crate::Subresource::FULL.bytes(to))
                .storage_buffer_mut(&mut out, Contents::Overwrite);
            let copy = &copy;
            pass.body(move |ctx| {
                assert_eq!(ctx.slice(to)?.size(), 256);
                copy.record(ctx, &[Bind::Buffer(from), Bind::Buffer(to)], 1)
            });
        }
        let out = frame.export_buffer(&out);
        let executed = gpu.run(&mut graph, frame);
        if gpu.draws {
            let words = gpu.words(executed.buffer(out).unwrap());
            assert_eq!(words[..3], [64064, 64065, 64066], "64 words, from the second half");
            assert_eq!(words[64..68], [4000, 4001, 4002, 4003], "four words, into the second half");
        }
    }
}

#[test]
fn a_frame_created_without_a_graph_runs_too() {
    let gpu = Gpu::noop();
    let mut frame = Frame::new();
    let mut color = frame.create_texture("color", square(8));
    frame.render_pass("draw").color(&mut color, Contents::clear_color([0.0; 4]));
    let color = frame.export_texture(&color);
    let mut encoder = gpu.encoder();
    let executed = frame.compile().unwrap().execute(&mut Graph::new(), &gpu.device, &mut encoder).unwrap();
    assert!(executed.texture(color).is_some());
}

#[test]
fn a_texture_beyond_the_limits_is_an_error_that_names_the_limit() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut huge = frame.create_texture("huge", TextureDesc::d2(100_000, 8, Format::Rgba8Unorm));
    frame.render_pass("draw").color(&mut huge, Contents::clear_color([0.0; 4]));
    frame.export_texture(&huge);
    let error = gpu.try_run(&mut graph, frame).err().unwrap();
    assert!(matches!(error, Error::Limit { .. }));
    assert!(error.to_string().contains("`huge` needs 100000 (max_texture_dimension_2d)"), "{error}");
}

#[test]
fn a_group_with_many_entries_is_cached_like_any() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let entry = |binding| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    };
    let entries: Vec<_> = (0..10).map(entry).collect();
    let layout = gpu
        .device
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    let mut groups = Vec::new();
    for _ in 0..2 {
        let mut frame = graph.frame();
        let blocks: Vec<_> = (0..10).map(|n| Bind::Uniform(frame.uniform(&number(n)))).collect();
        let mut color = frame.create_texture("color", square(8));
        let mut pass = frame.render_pass("draw");
        pass.color(&mut color, Contents::Overwrite);
        let (layout, groups) = (&layout, &mut groups);
        pass.body(move |ctx| {
            groups.push(ctx.bind_group(layout, &blocks)?);
            Ok(())
        });
        frame.export_texture(&color);
        gpu.run(&mut graph, frame);
    }
    assert_eq!(groups[0], groups[1]);
}
