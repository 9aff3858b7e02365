//! Histories: contents that one frame leaves to the next.

use super::gpu::{Draw, Gpu, NUMBERS, square};
use crate::{
    Bind, Contents, Error, Executed, Extent, Format, Frame, Graph, History, PoolLimits, Resize, Subresource,
    TextureDesc, TextureExport,
};
use std::sync::Arc;

/// A history that counts the frames that were executed: each texel of `current` is one more than in `previous`.
struct Counter<'g> {
    gpu: &'g Gpu,
    draw: &'g Draw,
    graph: Graph,
    desc: TextureDesc,
    resize: Resize,
}

impl<'g> Counter<'g> {
    fn new(gpu: &'g Gpu, draw: &'g Draw) -> Self {
        Self { gpu, draw, graph: Graph::new(), desc: square(8), resize: Resize::Reset }
    }

    /// Declares the history and the pass that counts in it.
    fn declare(&self, frame: &mut Frame<'g>) -> (History, TextureExport) {
        let mut history = frame.history("count", self.desc, self.resize);
        for mip in 0..self.desc.mip_levels {
            for layer in 0..self.desc.size.depth_or_array_layers {
                let part = Subresource::FULL.mip(mip).layer(layer);
                let mut pass = frame.render_pass("add one");
                let before = pass.subresource(part).sample(&history.previous);
                pass.subresource(part).color(&mut history.current, Contents::Overwrite);
                let draw = self.draw;
                pass.body(move |ctx| draw.record(ctx, &[Bind::Texture(before)]));
            }
        }
        let export = frame.export_texture(&history.current);
        (history, export)
    }

    /// Counts in one more frame and checks the count, and whether the history was valid.
    fn expect(&mut self, count: u32, valid: bool) -> wgpu::Texture {
        self.expect_with(count, valid, |_, _| {})
    }

    /// The same in a frame to which `add` adds more.
    fn expect_with(
        &mut self,
        count: u32,
        valid: bool,
        add: impl FnOnce(&mut Frame<'g>, &History),
    ) -> wgpu::Texture {
        let mut frame = self.graph.frame();
        let (history, export) = self.declare(&mut frame);
        assert_eq!(history.valid, valid, "before count {count}");
        add(&mut frame, &history);
        let executed = self.gpu.run(&mut self.graph, frame);
        self.check(&executed, export, count)
    }

    fn check(&self, executed: &Executed, export: TextureExport, count: u32) -> wgpu::Texture {
        let texture = executed.texture(export).unwrap().clone();
        for mip in 0..texture.mip_level_count() {
            for layer in 0..texture.depth_or_array_layers() {
                let texels = self.gpu.texels(&texture, mip, layer);
                assert!(texels.iter().all(|&texel| texel == count), "{texels:?} instead of {count}");
            }
        }
        texture
    }

    /// Runs a frame without the history.
    fn skip(&mut self) {
        self.gpu.run(&mut self.graph, Frame::new());
    }
}

fn each(test: impl Fn(Counter<'_>)) {
    for gpu in Gpu::all() {
        let draw = gpu.draw("loaded", NUMBERS);
        test(Counter::new(&gpu, &draw));
    }
}

#[test]
fn history_carries_contents_from_frame_to_frame() {
    each(|mut counter| {
        let halves = [counter.expect(1, false), counter.expect(2, true)];
        assert_ne!(halves[0], halves[1]);
        let known = counter.graph.device.histories.prior();
        for count in 3..8 {
            let half = counter.expect(count, true);
            assert_eq!(half, halves[(count as usize + 1) % 2], "the halves alternate");
        }
        assert!(Arc::ptr_eq(&known, &counter.graph.device.histories.prior()), "the list is unchanged");
        assert_eq!(counter.graph.bytes(), 2 * counter.desc.bytes());
        assert_eq!(counter.graph.plan_counts().compiled, 1, "the first frame has the same plan");
    });
}

#[test]
fn a_frame_that_is_not_executed_or_fails_has_no_effect() {
    each(|mut counter| {
        counter.expect(1, false);
        let mut dropped = counter.graph.frame();
        counter.declare(&mut dropped);
        drop(counter.graph.compile(dropped).unwrap());
        counter.expect(2, true);
        // It would have needed new textures as well.
        let mut failing = counter.graph.frame();
        let (history, _) = counter.declare(&mut failing);
        let mut pass = failing.compute_pass("fail");
        pass.storage_texture(&history.previous);
        pass.keep();
        pass.body(|_| Err(Error::body("on purpose")));
        assert!(counter.gpu.try_run(&mut counter.graph, failing).is_err());
        counter.expect(3, true);
    });
}

#[test]
fn a_history_keeps_its_contents_with_a_new_usage() {
    each(|mut counter| {
        counter.expect(1, false);
        let old = counter.expect(2, true);
        let new = counter.expect_with(3, true, |frame, history| {
            let mut pass = frame.compute_pass("needs another usage");
            pass.storage_texture(&history.previous);
            pass.keep();
        });
        assert!(!old.usage().contains(wgpu::TextureUsages::STORAGE_BINDING));
        assert!(new.usage().contains(wgpu::TextureUsages::STORAGE_BINDING));
        assert_eq!(counter.graph.bytes(), 2 * counter.desc.bytes());
        // The usage is kept, and so are the textures.
        counter.expect(4, true);
        assert_eq!(counter.expect(5, true), new);
    });
}

#[test]
fn all_mips_and_layers_keep_their_contents_with_a_new_usage_and_a_resize() {
    each(|mut counter| {
        counter.resize = Resize::Resample;
        counter.desc = TextureDesc { mip_levels: 3, ..square(8).layers(2) };
        counter.expect(1, false);
        counter.expect_with(2, true, |frame, history| {
            let mut pass = frame.compute_pass("needs another usage");
            pass.subresource(Subresource::FULL.mip(0)).storage_texture(&history.previous);
            pass.keep();
        });
        counter.desc = TextureDesc { mip_levels: 5, ..square(16).layers(2) };
        let usage = counter.expect(3, true).usage();
        assert!(usage.contains(wgpu::TextureUsages::STORAGE_BINDING));
        counter.desc = TextureDesc { mip_levels: 1, ..square(4).layers(2) };
        counter.expect(4, true);
        assert_eq!(counter.graph.bytes(), 2 * counter.desc.bytes());
    });
}

#[test]
fn a_resize_resets_or_resamples_as_declared() {
    each(|mut counter| {
        counter.expect(1, false);
        counter.expect(2, true);
        counter.desc = square(16);
        counter.expect(1, false);
        counter.expect(2, true);
        counter.resize = Resize::Resample;
        counter.expect(3, true);
        counter.desc = TextureDesc::d2(32, 4, NUMBERS);
        counter.expect(4, true);
        counter.desc = square(8);
        counter.expect(5, true);
        // From and to the earlier size, in frames whose plans are cached.
        counter.resize = Resize::Reset;
        counter.desc = square(16);
        counter.expect(1, false);
    });
}

#[test]
fn another_format_or_number_of_layers_resets() {
    each(|mut counter| {
        counter.resize = Resize::Resample;
        counter.expect(1, false);
        counter.expect(2, true);
        counter.desc = square(8).layers(2);
        counter.expect(1, false);
        counter.expect(2, true);
        counter.desc.size.depth_or_array_layers = 1;
        counter.expect(1, false);
        counter.desc.format = Format::R8Uint;
        let (draw, gpu) = (counter.gpu.draw("loaded", Format::R8Uint), counter.gpu);
        let mut frame = counter.graph.frame();
        let other = Counter { gpu, draw: &draw, graph: Graph::new(), ..counter };
        let (history, _) = other.declare(&mut frame);
        assert!(!history.valid);
        let (mut graph, desc) = (counter.graph, counter.desc);
        gpu.run(&mut graph, frame);
        assert_eq!(graph.bytes(), 2 * desc.bytes());
    });
}

#[test]
fn frames_without_the_history_keep_it_until_it_has_been_idle_too_long() {
    each(|mut counter| {
        counter.graph.set_limits(PoolLimits { idle_frames: 2, budget_bytes: Some(0) });
        counter.expect(1, false);
        for count in [2, 3] {
            counter.skip();
            counter.skip();
            counter.expect(count, true);
        }
        (0..3).for_each(|_| counter.skip());
        assert_eq!(counter.graph.bytes(), 0);
        counter.expect(1, false);
    });
}

#[test]
fn frames_of_other_plans_continue_the_history() {
    each(|mut counter| {
        for round in 0..3 {
            counter.expect(2 * round + 1, round > 0);
            counter.expect_with(2 * round + 2, true, |frame, history| {
                let mut copy = frame.create_texture("copy", history_desc(frame, history));
                frame.copy_pass("copy").texture(&history.previous, &mut copy);
                frame.export_texture(&copy);
            });
        }
        assert_eq!(counter.graph.plan_counts().compiled, 2);
    });
}

fn history_desc(frame: &Frame<'_>, history: &History) -> TextureDesc {
    frame.texture_desc(&history.previous).unwrap()
}

#[test]
fn views_have_separate_histories() {
    each(|mut counter| {
        // The right view only every second frame, the outer one always.
        for (left, right) in [(1, Some(1)), (2, None), (3, Some(2)), (4, None), (5, Some(3))] {
            let mut frame = counter.graph.frame();
            let mut exports = vec![(left, counter.declare(&mut frame).1)];
            exports.push((left, frame.view("left", |frame| counter.declare(frame).1)));
            if let Some(right) = right {
                let (history, export) =
                    frame.view("right", |frame| frame.node("node", |f| counter.declare(f)));
                assert_eq!(history.valid, right > 1);
                exports.push((right, export));
            }
            let executed = counter.gpu.run(&mut counter.graph, frame);
            for (count, export) in exports {
                counter.check(&executed, export, count);
            }
        }
        assert_eq!(counter.graph.bytes(), 6 * counter.desc.bytes());
    });
}

#[test]
fn frames_declared_ahead_and_recorded_on_threads_count_in_the_order_of_execution() {
    each(|mut counter| {
        counter.expect(1, false);
        let frames = [0; 3].map(|_| {
            let mut frame = counter.graph.frame();
            let (history, export) = counter.declare(&mut frame);
            assert!(history.valid);
            (frame, export)
        });
        let mut submitted = Vec::new();
        for (frame, export) in frames {
            let compiled = counter.graph.compile(frame).unwrap();
            let (executed, buffers) =
                compiled.execute_on_threads(&mut counter.graph, &counter.gpu.device, 2).unwrap();
            submitted.push((executed, export));
            counter.gpu.queue.submit(buffers);
        }
        let (executed, export) = submitted.pop().unwrap();
        counter.check(&executed, export, 4);
    });
}

#[test]
fn two_histories_of_one_name_in_one_view_are_an_error() {
    let desc = square(8);
    let mut frame = Frame::new();
    for view in ["left", "right", "left"] {
        frame.view(view, |frame| {
            let mut history = frame.history("count", desc, Resize::Reset);
            frame.render_pass("clear").color(&mut history.current, Contents::clear_color([0.0; 4]));
        });
    }
    let error = frame.compile().err().unwrap();
    assert!(error.to_string().contains("`count` is invalid: duplicate history name in its view"), "{error}");
}

/// Clears a history in the first frame; in the next, draws its contents with the fragment stage `read` into numbers.
fn kept(gpu: &Gpu, desc: TextureDesc, clear: Contents, read: &'static str, expected: u32) {
    let draw = gpu.draw(read, NUMBERS);
    let mut graph = Graph::new();
    for number in 0..3 {
        let mut frame = graph.frame();
        let mut history = frame.history("history", desc, Resize::Resample);
        assert_eq!(history.valid, number > 0);
        let mut pass = frame.render_pass("write");
        if desc.format.is_depth_stencil_format() {
            pass.depth(&mut history.current, clear);
        } else {
            pass.color(&mut history.current, clear);
        }
        if number == 0 {
            gpu.run(&mut graph, frame);
            continue;
        }
        let mut out = frame.create_texture("out", square(8));
        let mut pass = frame.render_pass("read");
        let before = pass.sample(&history.previous);
        pass.color(&mut out, Contents::Overwrite);
        pass.body(|ctx| draw.record(ctx, &[Bind::Texture(before)]));
        let out = frame.export_texture(&out);
        let executed = gpu.run(&mut graph, frame);
        gpu.assert_filled(executed.texture(out).unwrap(), expected);
    }
}

#[test]
fn depth_and_samples_keep_their_contents_with_a_new_usage() {
    for gpu in Gpu::all() {
        for format in [Format::Depth16Unorm, Format::Depth24Plus, Format::Depth32Float] {
            kept(&gpu, TextureDesc::d2(8, 8, format), Contents::clear_depth(0.25), "hundredths", 25);
        }
        let samples = TextureDesc { samples: 4, ..TextureDesc::d2(8, 8, Format::R16Uint) };
        kept(&gpu, samples, Contents::clear_color([300.0, 0.0, 0.0, 0.0]), "last_sample", 300);
        let stencil = TextureDesc::d2(8, 8, Format::Depth24PlusStencil8);
        kept(&gpu, stencil, Contents::clear_depth_stencil(0.5, 3), "hundredths", 50);
    }
}

#[test]
fn a_filtered_format_keeps_a_constant_colour_through_a_resize() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        for (number, (width, height)) in [(16, 16), (24, 9), (5, 40)].into_iter().enumerate() {
            let desc = TextureDesc::d2(width, height, Format::Rgba8Unorm);
            let mut frame = graph.frame();
            let mut history = frame.history("colour", desc, Resize::Resample);
            assert_eq!(history.valid, number > 0);
            let contents = Contents::clear_color([1.0, 0.2, 0.0, 0.6]);
            frame.render_pass("clear").color(&mut history.current, contents);
            let mut copy = frame.create_texture("copy", desc);
            frame.copy_pass("copy").texture(&history.previous, &mut copy);
            let copy = frame.export_texture(&copy);
            let executed = gpu.run(&mut graph, frame);
            let expected = if number == 0 { 0 } else { u32::from_le_bytes([255, 51, 0, 153]) };
            gpu.assert_filled(executed.texture(copy).unwrap(), expected);
        }
    }
}

#[test]
fn a_history_that_cannot_be_resampled_is_reset_and_not_valid() {
    let of = |format| TextureDesc::d2(8, 8, format);
    let volume = TextureDesc {
        size: Extent { width: 8, height: 8, depth_or_array_layers: 2 },
        dimension: wgpu::TextureDimension::D3,
        ..of(NUMBERS)
    };
    let samples = TextureDesc { samples: 4, ..of(Format::Rgba8Unorm) };
    for gpu in Gpu::all() {
        for (desc, fits) in [
            (of(Format::Depth24PlusStencil8), false),
            (volume, false),
            (samples, false),
            (of(Format::Depth32Float), true),
            (of(Format::Rgba32Float), true),
        ] {
            let mut graph = Graph::new();
            for (side, valid) in [(8, false), (8, true), (16, fits), (16, true)] {
                let mut frame = graph.frame();
                let size = Extent { width: side, ..desc.size };
                let mut history = frame.history("history", TextureDesc { size, ..desc }, Resize::Resample);
                assert_eq!(history.valid, valid, "{desc:?}");
                for layer in 0..if desc.dimension == wgpu::TextureDimension::D3 { 2 } else { 1 } {
                    let mut pass = frame.render_pass("write");
                    if desc.format.is_depth_stencil_format() {
                        pass.depth(&mut history.current, Contents::clear_depth(0.5));
                    } else {
                        let contents = Contents::clear_color([1.0; 4]);
                        pass.subresource(Subresource::FULL.layer(layer))
                            .color(&mut history.current, contents);
                    }
                }
                gpu.run(&mut graph, frame);
            }
        }
    }
}
