//! Poison values in contents that nobody wrote.

use super::gpu::{Gpu, NUMBERS, depth_test, number, square};
use crate::{
    Bind, BufferDesc, ClearValue, Contents, Extent, Format, Frame, Graph, LoadAction, LoadReason, Rect,
    Resize, StoreAction, Subresource, TextureDesc, TextureExport,
};
use std::sync::Mutex;

const WORD: u32 = 0x7fcd_cdcd;
const MAGENTA: u32 = u32::from_le_bytes([237, 18, 237, 135]);

fn poisoned(on: bool) -> Graph {
    let mut graph = Graph::new();
    graph.set_poison(on);
    graph
}

#[test]
fn poison_shows_texels_that_a_false_overwrite_leaves_unwritten() {
    let Some(gpu) = Gpu::drawing() else { return };
    for (format, entry, drawn, poison) in
        [(Format::Rgba8Unorm, "white", u32::MAX, MAGENTA), (NUMBERS, "seven", 7, u32::MAX)]
    {
        let draw = gpu.draw(entry, format);
        let mut graph = poisoned(true);
        // Off again at the end: the same frame, for which only the objects are created again.
        for (number, on) in [true, true, false].into_iter().enumerate() {
            graph.set_poison(on);
            let mut frame = graph.frame();
            let mut color = frame.create_texture("color", TextureDesc::d2(8, 8, format));
            let mut pass = frame.render_pass("upper half");
            pass.color(&mut color, Contents::Overwrite);
            pass.body(|ctx| {
                ctx.pass.set_scissor_rect(0, 0, 8, 4);
                draw.record_without_bindings(ctx);
                Ok(())
            });
            let color = frame.export_texture(&color);
            let executed = gpu.run(&mut graph, frame);
            let texels = gpu.texels(executed.texture(color).unwrap(), 0, 0);
            assert_eq!(texels[..32], [drawn; 32], "frame {number}");
            assert_eq!(texels[32..], [if on { poison } else { 0 }; 32], "frame {number}");
        }
    }
}

#[test]
fn poison_shows_a_multisampled_attachment_that_is_not_overwritten() {
    for gpu in Gpu::all() {
        let mut graph = poisoned(true);
        let mut frame = graph.frame();
        let desc = TextureDesc::d2(8, 8, Format::Rgba8Unorm);
        let mut samples = frame.create_texture("samples", TextureDesc { samples: 4, ..desc });
        let mut resolved = frame.create_texture("resolved", desc);
        let mut pass = frame.render_pass("draws nothing");
        pass.color(&mut samples, Contents::Overwrite);
        pass.resolve(&mut resolved);
        let resolved = frame.export_texture(&resolved);
        let executed = gpu.run(&mut graph, frame);
        let usage = executed.plan().resource(samples.id()).texture_usage;
        assert!(usage.contains(wgpu::TextureUsages::TRANSIENT_ATTACHMENT));
        gpu.assert_filled(executed.texture(resolved).unwrap(), MAGENTA);
    }
}

/// Returns whether a word of a texture of that format is its poison value.
fn is_poison(format: Format, word: u32) -> bool {
    let halves = [word & 0xffff, word >> 16];
    match format {
        Format::Rgba8Unorm | Format::Rgba8UnormSrgb => word == MAGENTA || halves[1] >> 8 == 135,
        Format::R8Unorm => word == 0xeded_eded,
        Format::R32Float | Format::Rgba32Float => f32::from_bits(word).is_nan(),
        Format::R16Float | Format::Rgba16Float => halves.iter().all(|half| half & 0x7fff > 0x7c00),
        Format::Rgba8Snorm | Format::Rgb9e5Ufloat => word == WORD,
        Format::Depth32Float => word == 0.53f32.to_bits(),
        Format::Depth16Unorm => halves == [34734, 34734],
        Format::Stencil8 => word == 0xcdcd_cdcd,
        _ => word == u32::MAX,
    }
}

#[test]
fn every_kind_of_texture_is_filled_completely() {
    use wgpu::TextureFormat::*;
    let formats = [
        R8Unorm,
        Rgba8Unorm,
        Rgba8UnormSrgb,
        Rgba8Snorm,
        R32Float,
        Rgba32Float,
        R16Float,
        Rgba16Float,
        Rgb9e5Ufloat,
        R8Uint,
        R16Uint,
        R32Uint,
        Rgba32Uint,
        Rgb10a2Uint,
        R8Sint,
        Rgba16Sint,
        R32Sint,
        Depth32Float,
        Depth16Unorm,
        Stencil8,
    ];
    let flat = formats.map(|format| TextureDesc { mip_levels: 2, ..TextureDesc::d2(8, 8, format).layers(3) });
    let size = Extent { width: 8, height: 4, depth_or_array_layers: 4 };
    let volume = |format| TextureDesc {
        size,
        mip_levels: 2,
        dimension: wgpu::TextureDimension::D3,
        ..TextureDesc::d2(8, 4, format)
    };
    let line = TextureDesc { dimension: wgpu::TextureDimension::D1, ..TextureDesc::d2(64, 1, R32Uint) };
    for gpu in Gpu::all() {
        let all = flat.iter().copied().chain([volume(R32Uint), volume(Rgba8Snorm), line]);
        for desc in all {
            let mut graph = poisoned(true);
            let mut frame = graph.frame();
            let mut texture = frame.create_texture("texture", desc);
            frame.encoder_pass("writes nothing").copy_target(&mut texture, Contents::Overwrite);
            let export = frame.export_texture(&texture);
            let executed = gpu.run(&mut graph, frame);
            let texture = executed.texture(export).unwrap();
            for mip in 0..desc.mip_levels {
                let size = desc.size.mip_level_size(mip, desc.dimension);
                for layer in 0..size.depth_or_array_layers {
                    let words = gpu.texels(texture, mip, layer);
                    // A 1D texture is filled by a copy.
                    let format =
                        if desc.dimension == wgpu::TextureDimension::D1 { Rgba8Snorm } else { desc.format };
                    let poison = words.iter().all(|&word| is_poison(format, word));
                    assert!(poison, "{desc:?}, mip {mip}, layer {layer}: {words:x?}");
                }
            }
        }
    }
}

#[test]
fn stored_samples_and_depth_with_stencil_are_filled() {
    for gpu in Gpu::all() {
        let (last_sample, aspects) = (gpu.draw("last_sample", NUMBERS), gpu.draw("aspects", NUMBERS));
        let mut graph = poisoned(true);
        let mut frame = graph.frame();
        let desc = TextureDesc { samples: 4, ..TextureDesc::d2(8, 8, Format::R16Uint) };
        let mut samples = frame.create_texture("samples", desc);
        frame.encoder_pass("writes nothing").attachment(&mut samples, Contents::Overwrite);
        let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth24PlusStencil8));
        frame.encoder_pass("writes nothing").copy_target(&mut depth, Contents::Overwrite);
        let outs = [&samples, &depth].map(|texture| {
            let mut out = frame.create_texture("out", square(8));
            let mut pass = frame.render_pass("show");
            let own = [crate::Aspect::Depth, crate::Aspect::Stencil].map(|aspect| match texture == &depth {
                true => pass.subresource(Subresource::FULL.aspect(aspect)).sample(texture),
                false => pass.sample(texture),
            });
            pass.color(&mut out, Contents::Overwrite);
            let (last_sample, aspects, is_depth) = (&last_sample, &aspects, texture == &depth);
            pass.body(move |ctx| match is_depth {
                true => aspects.record(ctx, &own.map(Bind::Texture)),
                false => last_sample.record(ctx, &[Bind::Texture(own[0])]),
            });
            frame.export_texture(&out)
        });
        let executed = gpu.run(&mut graph, frame);
        gpu.assert_filled(executed.texture(outs[0]).unwrap(), 65535);
        gpu.assert_filled(executed.texture(outs[1]).unwrap(), 53 + 1000 * 0xcd);
    }
}

#[test]
fn buffers_are_filled_to_their_end() {
    for gpu in Gpu::all() {
        for bytes in [4, 260, (1 << 20) + 4, 5 << 20] {
            let mut graph = poisoned(true);
            let mut frame = graph.frame();
            let mut buffer = frame.create_buffer("buffer", BufferDesc::new(bytes));
            frame.compute_pass("writes nothing").storage_buffer_mut(&mut buffer, Contents::Overwrite);
            let buffer = frame.export_buffer(&buffer);
            let executed = gpu.run(&mut graph, frame);
            let words = gpu.words(executed.buffer(buffer).unwrap());
            assert_eq!(words.len() as u64, bytes / 4);
            assert!(words.iter().all(|&word| word == WORD));
        }
    }
}

#[test]
fn an_attachment_is_filled_after_a_discard() {
    for gpu in Gpu::all() {
        for on in [true, false] {
            let physical = Mutex::new(None);
            let mut graph = poisoned(on);
            let mut frame = graph.frame();
            let mut color = frame.create_texture("color", square(8));
            let mut copy = frame.create_texture("copy", square(8));
            frame.render_pass("clear").color(&mut color, Contents::clear_color([7.0; 4]));
            frame.copy_pass("copy").texture(&color, &mut copy);
            let copy = frame.export_texture(&copy);
            let mut pass = frame.render_pass("clear again");
            let token = pass.color(&mut color, Contents::clear_color([9.0; 4]));
            pass.keep();
            pass.body(|ctx| {
                *physical.lock().unwrap() = Some(ctx.texture(token)?.clone());
                Ok(())
            });
            let executed = gpu.run(&mut graph, frame);
            let again = executed.plan().find_pass("clear again").unwrap();
            let ops = executed.plan().accesses(again).next().unwrap().ops.unwrap();
            assert_eq!(ops.store, StoreAction::Discard);
            gpu.assert_filled(executed.texture(copy).unwrap(), 7);
            let physical = physical.into_inner().unwrap().unwrap();
            gpu.assert_filled(&physical, if on { u32::MAX } else { 0 });
        }
    }
}

/// Runs a frame three times without and three times with poison, and compares the results.
fn draws_the_same<'f>(gpu: &Gpu, declare: impl Fn(&mut Frame<'f>) -> Vec<TextureExport>) {
    let texels = [false, true].map(|on| {
        let mut graph = poisoned(on);
        let frames = (0..3).map(|_| {
            let mut frame = graph.frame();
            let exports = declare(&mut frame);
            let executed = gpu.run(&mut graph, frame);
            let textures = exports.iter().map(|&export| executed.texture(export).unwrap());
            textures.map(|texture| gpu.texels(texture, 0, 0)).collect::<Vec<_>>()
        });
        frames.collect::<Vec<_>>()
    });
    assert_eq!(texels[0], texels[1]);
    let any = texels[0].iter().flatten().flatten().any(|&texel| texel != 0);
    assert_eq!(any, gpu.draws, "something is drawn");
}

#[test]
fn a_chain_through_few_slots_draws_the_same() {
    for gpu in Gpu::all() {
        let (seven, loaded) = (gpu.draw("seven", NUMBERS), gpu.draw("loaded", NUMBERS));
        draws_the_same(&gpu, |frame| {
            let mut last = frame.create_texture("first", square(8));
            let mut pass = frame.render_pass("first");
            pass.color(&mut last, Contents::Overwrite);
            pass.body(|ctx| seven.record(ctx, &[]));
            for _ in 0..5 {
                let mut next = frame.create_texture("next", square(8));
                let mut pass = frame.render_pass("next");
                let token = pass.sample(&last);
                pass.color(&mut next, Contents::Overwrite);
                let loaded = &loaded;
                pass.body(move |ctx| loaded.record(ctx, &[Bind::Texture(token)]));
                last = next;
            }
            vec![frame.export_texture(&last)]
        });
    }
}

#[test]
fn buffers_and_histories_hold_the_same() {
    for gpu in Gpu::all() {
        let (copy, add) = (gpu.compute("copy_words"), gpu.compute("add_number"));
        let loaded = gpu.draw("loaded", NUMBERS);
        let mut graph = poisoned(true);
        for round in 1..4 {
            let mut frame = graph.frame();
            let words: Vec<u8> = (0..100u32).flat_map(u32::to_le_bytes).collect();
            let words = frame.upload_buffer("words", words);
            let block = frame.uniform(&number(5));
            let mut copied = frame.create_buffer("copied", BufferDesc::new(400));
            let mut pass = frame.compute_pass("copy");
            let tokens =
                (pass.storage_buffer(&words), pass.storage_buffer_mut(&mut copied, Contents::Overwrite));
            pass.body(|ctx| copy.record(ctx, &[Bind::Buffer(tokens.0), Bind::Buffer(tokens.1)], 2));
            let mut pass = frame.compute_pass("add");
            let token = pass.storage_buffer_mut(&mut copied, Contents::Preserve);
            pass.body(|ctx| add.record(ctx, &[Bind::Uniform(block), Bind::Buffer(token)], 2));
            let copied = frame.export_buffer(&copied);
            let mut count = frame.history("count", square(8), Resize::Reset);
            let mut pass = frame.render_pass("count");
            let before = pass.sample(&count.previous);
            pass.color(&mut count.current, Contents::Overwrite);
            pass.body(|ctx| loaded.record(ctx, &[Bind::Texture(before)]));
            let count = frame.export_texture(&count.current);
            let executed = gpu.run(&mut graph, frame);
            gpu.assert_filled(executed.texture(count).unwrap(), round);
            if gpu.draws {
                let expected: Vec<_> = (0..100).map(|word| word + 100_005).collect();
                assert_eq!(gpu.words(executed.buffer(copied).unwrap()), expected);
            }
        }
    }
}

#[test]
fn tiles_that_are_cleared_after_others_are_overwritten_draw_the_same() {
    for gpu in Gpu::all() {
        let seven = gpu.draw("seven", NUMBERS);
        let tiles = [0, 4, 8].map(|x| Subresource::FULL.rect(Rect::new(x, 2, 4, 4)));
        draws_the_same(&gpu, |frame| {
            let mut atlas = frame.create_texture("atlas", square(16));
            let clear = |value| Contents::clear_color([value, 0.0, 0.0, 0.0]);
            for (tile, contents) in tiles.into_iter().zip([Contents::Overwrite, clear(0.0), clear(3.0)]) {
                let mut pass = frame.render_pass("tile");
                pass.subresource(tile).color(&mut atlas, contents);
                let seven = &seven;
                pass.body(move |ctx| match contents {
                    Contents::Overwrite => seven.record(ctx, &[]),
                    _ => Ok(()),
                });
            }
            let exports = tiles.map(|tile| {
                let mut out = frame.create_texture("out", square(4));
                frame.copy_pass("out").texture_region(&atlas, tile, &mut out, Subresource::FULL);
                frame.export_texture(&out)
            });
            exports.to_vec()
        });
    }
}

#[test]
fn a_slice_next_to_a_discarded_one_holds_the_same() {
    for gpu in Gpu::all() {
        let seven = gpu.draw("seven", NUMBERS);
        draws_the_same(&gpu, |frame| {
            let size = Extent { width: 4, height: 4, depth_or_array_layers: 3 };
            let desc = TextureDesc { size, dimension: wgpu::TextureDimension::D3, ..square(4) };
            let mut volume = frame.create_texture("volume", desc);
            for slice in [1, 0] {
                let mut pass = frame.render_pass("slice");
                pass.subresource(Subresource::FULL.layer(slice)).color(&mut volume, Contents::Overwrite);
                pass.keep();
                let seven = &seven;
                pass.body(move |ctx| seven.record(ctx, &[]));
            }
            let mut out = frame.create_texture("out", square(4));
            frame.copy_pass("out").texture_region(
                &volume,
                Subresource::FULL.layer(1),
                &mut out,
                Subresource::FULL,
            );
            vec![frame.export_texture(&out)]
        });
    }
}

/// The difficulty of the tiles above: the plan uses the zeros that one pass loads for the clear of another.
#[test]
fn a_clear_may_rely_on_the_load_of_an_earlier_pass() {
    let mut frame = Frame::new();
    let mut atlas = frame.create_texture("atlas", square(16));
    let tiles = [0, 4].map(|x| Subresource::FULL.rect(Rect::new(x, 2, 4, 4)));
    frame.render_pass("cover").subresource(tiles[0]).color(&mut atlas, Contents::Overwrite);
    frame.render_pass("clear").subresource(tiles[1]).color(&mut atlas, Contents::clear_color([0.0; 4]));
    for tile in tiles {
        let mut out = frame.create_texture("out", square(4));
        frame.copy_pass("out").texture_region(&atlas, tile, &mut out, Subresource::FULL);
        frame.export_texture(&out);
    }
    let plan = frame.compile().unwrap().into_plan();
    let [cover, clear] = ["cover", "clear"].map(|name| {
        let pass = plan.find_pass(name).unwrap();
        plan.accesses(pass).next().unwrap().ops.unwrap()
    });
    assert_eq!(cover.load, LoadAction::Clear(ClearValue::Color([0.0; 4])));
    assert_eq!(cover.load_reason, LoadReason::RestUnneeded);
    assert_eq!((clear.load, clear.clear_drawn), (LoadAction::Continue, false));
}

#[test]
fn samples_with_depth_and_mips_draw_the_same() {
    for gpu in Gpu::all() {
        let depth_format = Format::Depth32Float;
        let test = depth_test(depth_format, wgpu::CompareFunction::Greater, true);
        let white = gpu.draw_with("white", Format::Rgba8Unorm.into(), Some(test), 4);
        let (seven, loaded) = (gpu.draw("seven", NUMBERS), gpu.draw("loaded", NUMBERS));
        draws_the_same(&gpu, |frame| {
            let samples = |format| TextureDesc { samples: 4, ..TextureDesc::d2(8, 8, format) };
            let mut color = frame.create_texture("color", samples(Format::Rgba8Unorm));
            let mut depth = frame.create_texture("depth", samples(depth_format));
            let mut resolved = frame.create_texture("resolved", TextureDesc::d2(8, 8, Format::Rgba8Unorm));
            let mut pass = frame.render_pass("draw");
            pass.color(&mut color, Contents::clear_color([0.0; 4]));
            pass.resolve(&mut resolved);
            pass.depth(&mut depth, Contents::clear_depth(0.0));
            pass.body(|ctx| {
                ctx.pass.set_scissor_rect(0, 0, 5, 5);
                white.record(ctx, &[])
            });
            let mut mips = frame.create_texture("mips", TextureDesc { mip_levels: 3, ..square(8) });
            for mip in 0..3 {
                let mut pass = frame.render_pass("mip");
                let part = |mip| Subresource::FULL.mip(mip);
                let above = (mip > 0).then(|| pass.subresource(part(mip - 1)).sample(&mips));
                pass.subresource(part(mip)).color(&mut mips, Contents::Overwrite);
                let (seven, loaded) = (&seven, &loaded);
                pass.body(move |ctx| match above {
                    Some(above) => loaded.record(ctx, &[Bind::Texture(above)]),
                    None => seven.record(ctx, &[]),
                });
            }
            let mut last = frame.create_texture("last", square(2));
            frame.copy_pass("last").texture_region(
                &mips,
                Subresource::FULL.mip(2),
                &mut last,
                Subresource::FULL,
            );
            vec![frame.export_texture(&resolved), frame.export_texture(&last)]
        });
    }
}
