//! Copies that the graph records itself, and uploads.

use super::gpu::{Gpu, NUMBERS, number, square};
use crate::{
    Aspect, Bind, Buffer, BufferDesc, BufferExport, Contents, Error, Format, Frame, Graph, Rect, Subresource,
    TextureDesc,
};

fn bytes(words: impl IntoIterator<Item = u32>) -> Vec<u8> {
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}

#[test]
fn bytes_are_copied_between_a_format_and_its_srgb_form() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let desc = TextureDesc::d2(16, 16, Format::Rgba8Unorm);
        let mut plain = frame.create_texture("plain", desc);
        frame.render_pass("clear").color(&mut plain, Contents::clear_color([0.5, 0.0, 0.0, 1.0]));
        let mut encoded =
            frame.create_texture("encoded", TextureDesc { format: Format::Rgba8UnormSrgb, ..desc });
        frame.copy_pass("copy").texture(&plain, &mut encoded);
        let encoded = frame.export_texture(&encoded);
        let executed = gpu.run(&mut graph, frame);
        let texels = gpu.texels(executed.texture(encoded).unwrap(), 0, 0);
        assert!(texels.iter().all(|&texel| matches!(texel, 0xff00_007f | 0xff00_0080)), "{texels:x?}");
    }
}

#[test]
fn subresources_of_textures_are_copied_to_those_of_others() {
    for gpu in Gpu::all() {
        let draw = gpu.draw("place", NUMBERS);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut source =
            frame.create_texture("source", TextureDesc { mip_levels: 2, ..square(16).layers(2) });
        let part = Subresource::FULL.mip(1).layer(1);
        let mut pass = frame.render_pass("draw");
        pass.subresource(part).color(&mut source, Contents::Overwrite);
        pass.body(|ctx| {
            draw.record_without_bindings(ctx);
            Ok(())
        });
        let mut target = frame.create_texture("target", square(16).layers(3));
        for layer in 0..3 {
            let contents = Contents::clear_color([1.0, 0.0, 0.0, 0.0]);
            frame
                .render_pass("clear")
                .subresource(Subresource::FULL.layer(layer))
                .color(&mut target, contents);
        }
        let (from, to) = (Rect::new(4, 2, 3, 5), Rect::new(1, 9, 3, 5));
        let to = Subresource::FULL.layer(2).rect(to);
        frame.copy_pass("copy").texture_region(&source, part.rect(from), &mut target, to);
        let target = frame.export_texture(&target);
        let executed = gpu.run(&mut graph, frame);
        if !gpu.draws {
            continue;
        }
        let target = executed.texture(target).unwrap();
        let texels = gpu.texels(target, 0, 2);
        // The source has 8 texels a side, so centres are at odd sixteenths.
        assert_eq!(texels[9 * 16 + 1..9 * 16 + 4], [509, 511, 513]);
        assert_eq!(texels[13 * 16 + 1..13 * 16 + 4], [1309, 1311, 1313]);
        assert_eq!(texels.iter().filter(|&&texel| texel == 1).count(), 256 - 15);
        assert_eq!(gpu.texels(target, 0, 1), [1; 256]);
    }
}

#[test]
fn copies_that_wgpu_does_not_support_are_errors() {
    let gpu = Gpu::noop();
    let (tile, depth) =
        (Subresource::FULL.rect(Rect::new(0, 0, 4, 4)), Subresource::FULL.aspect(Aspect::Depth));
    let multisampled = TextureDesc { samples: 4, ..TextureDesc::d2(8, 8, Format::Rgba8Unorm) };
    for (desc, part, possible) in [
        (TextureDesc::d2(8, 8, Format::Depth32Float), Subresource::FULL, true),
        (TextureDesc::d2(8, 8, Format::Depth32Float), depth, true),
        (TextureDesc::d2(8, 8, Format::Depth32Float), Subresource::FULL.rect(Rect::new(0, 0, 8, 8)), true),
        (TextureDesc::d2(8, 8, Format::Depth32Float).layers(2), Subresource::FULL.layer(1), true),
        (TextureDesc::d2(8, 8, Format::Depth32Float), tile, false),
        (TextureDesc::d2(8, 8, Format::Depth24PlusStencil8), Subresource::FULL, true),
        (TextureDesc::d2(8, 8, Format::Depth24PlusStencil8), depth, false),
        (multisampled, Subresource::FULL, true),
        (multisampled, tile, false),
    ] {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let usage = wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::RENDER_ATTACHMENT;
        let source = frame.import_texture("source", &gpu.texture(desc, usage), true);
        let mut target = frame.create_texture("target", desc);
        frame.copy_pass("copy").texture_region(&source, part, &mut target, part).keep();
        match gpu.try_run(&mut graph, frame) {
            Ok(_) => assert!(possible, "{desc:?}, {part:?}"),
            Err(error) => {
                assert!(
                    !possible && matches!(error, Error::CopyMismatch { .. }),
                    "{desc:?}, {part:?}: {error}"
                );
            }
        }
    }
}

#[test]
fn several_layers_are_copied_at_once() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut source = frame.create_texture("source", square(8).layers(3));
        let mut target = frame.create_texture("target", square(8).layers(4));
        for layer in 0..3 {
            let contents = Contents::clear_color([f64::from(layer), 0.0, 0.0, 0.0]);
            frame
                .render_pass("clear")
                .subresource(Subresource::FULL.layer(layer))
                .color(&mut source, contents);
        }
        for to in [0..3, 3..4] {
            let from = Subresource::FULL.layers(0..to.end - to.start);
            frame.copy_pass("copy").texture_region(&source, from, &mut target, Subresource::FULL.layers(to));
        }
        let target = frame.export_texture(&target);
        let executed = gpu.run(&mut graph, frame);
        if !gpu.draws {
            continue;
        }
        for (layer, expected) in [0, 1, 2, 0].into_iter().enumerate() {
            let texels = gpu.texels(executed.texture(target).unwrap(), 0, layer as u32);
            assert_eq!(texels, [expected; 64]);
        }
    }
}

#[test]
fn ranges_of_buffers_are_copied_to_ranges_of_others() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let source = frame.upload_buffer("source", bytes(0..8));
        let mut target = frame.upload_buffer("target", bytes([100; 6]));
        let (from, to) = (Subresource::FULL.bytes(8..20), Subresource::FULL.bytes(4..16));
        frame.copy_pass("copy").buffer_range(&source, from, &mut target, to);
        let target = frame.export_buffer(&target);
        let executed = gpu.run(&mut graph, frame);
        assert_eq!(gpu.words(executed.buffer(target).unwrap()), [100, 2, 3, 4, 100, 100]);
    }
}

/// Copies an upload, so that the buffer is from the pool like any other.
fn uploaded<'f>(frame: &mut Frame<'f>, bytes: &'f [u8]) -> (Buffer, BufferExport) {
    let upload = frame.upload_buffer("upload", bytes);
    let export = frame.export_buffer(&upload);
    (upload, export)
}

#[test]
fn uploads_of_any_length_arrive_with_zeros_at_the_end() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        // Large ones first, so that later ones get dirty memory.
        for round in 0..2 {
            for length in [1000usize, 5, 4, 1, 0] {
                let bytes = vec![0xab; length];
                let mut frame = graph.frame();
                let (_, export) = uploaded(&mut frame, &bytes);
                let executed = gpu.run(&mut graph, frame);
                let words = gpu.words(executed.buffer(export).unwrap());
                let seen: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
                assert_eq!(seen[..length], bytes, "round {round}");
                assert!(seen[length..].iter().all(|&byte| byte == 0), "round {round}: {seen:?} of {length}");
            }
        }
    }
}

#[test]
fn an_empty_upload_next_to_others_gets_none_of_their_bytes() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        let large = vec![0xab; 64 * 1024];
        let mut frame = graph.frame();
        let (_, first) = uploaded(&mut frame, &large);
        let (_, empty) = uploaded(&mut frame, &[]);
        let executed = gpu.run(&mut graph, frame);
        assert_eq!(gpu.words(executed.buffer(empty).unwrap()), [0]);
        assert_eq!(gpu.words(executed.buffer(first).unwrap()).len(), 16 * 1024);
    }
}

#[test]
fn an_upload_that_nothing_reads_is_not_created() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    frame.upload_buffer("unread", vec![0; 1 << 20]);
    assert_eq!(gpu.run(&mut graph, frame).plan().order().len(), 0);
    assert_eq!(graph.bytes(), 0);
}

#[test]
fn frames_recorded_before_any_is_submitted_keep_their_own_uniforms_and_uploads() {
    for gpu in Gpu::all() {
        let add = gpu.compute("add_number");
        let mut graph = Graph::new();
        for round in 0..3u32 {
            let mut recorded = Vec::new();
            for own in 0..4u32 {
                let mut frame = graph.frame();
                let mut sums = frame.upload_buffer("sums", bytes([100 * own + round; 4]));
                // Their number increases, so that their buffer has to grow in between.
                let blocks: Vec<_> =
                    (0..50 * (own + 1)).map(|index| frame.uniform(&number(own * 7 + index))).collect();
                let mut pass = frame.compute_pass("add");
                let token = pass.storage_buffer_mut(&mut sums, Contents::Preserve);
                let (last, add) = (blocks[blocks.len() - 1], &add);
                pass.body(move |ctx| add.record(ctx, &[Bind::Uniform(last), Bind::Buffer(token)], 1));
                let export = frame.export_buffer(&sums);
                let mut encoder = gpu.encoder();
                let compiled = graph.compile(frame).unwrap();
                let executed = compiled.execute(&mut graph, &gpu.device, &mut encoder).unwrap();
                // The frames share the buffer, so its contents are read in the encoder of each frame.
                let buffer = executed.buffer(export).unwrap();
                let back = crate::ReadBack::buffer(&gpu.device, &mut encoder, "sums", buffer, 0..16).unwrap();
                let expected = 100 * own + round + own * 7 + 50 * (own + 1) - 1;
                recorded.push((encoder.finish(), back, expected));
            }
            crate::test_device::valid(&gpu.device, || {
                for (commands, back, expected) in recorded.into_iter().rev() {
                    gpu.queue.submit([commands]);
                    let bytes = back.wait(&gpu.device).unwrap();
                    if gpu.draws {
                        assert_eq!(bytes[..4], expected.to_le_bytes());
                    }
                }
            });
        }
    }
}

#[test]
fn a_dynamic_offset_moves_along_a_buffer() {
    // Four ranges of one buffer through one bind group.
    let gpu = Gpu::noop();
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Storage { read_only: false },
                has_dynamic_offset: true,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut buffer = frame.create_buffer("buffer", BufferDesc::new(1024));
    let mut pass = frame.compute_pass("pass");
    let token = pass.storage_buffer_mut(&mut buffer, Contents::Overwrite);
    pass.keep();
    pass.body(|ctx| {
        let group = ctx.bind_group(&layout, &[Bind::BufferRange(token, 0..256)])?;
        for range in 0..4 {
            ctx.pass.set_bind_group(0, &group, &[256 * range]);
        }
        Ok(())
    });
    gpu.run(&mut graph, frame);
}
