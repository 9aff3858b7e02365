//! Depth and stencil: tested while sampled, read by aspect, and not stored where unused.

use super::gpu::{Gpu, NUMBERS, aspect, depth_test, square};
use crate::{Aspect, Bind, Contents, Format, Frame, Graph, Rect, Texture, TextureDesc};

fn depth(frame: &mut Frame<'_>, format: Format) -> Texture {
    frame.create_texture("depth", TextureDesc::d2(8, 8, format))
}

/// Returns both aspects of what `fill` draws as a pass reads them: 1000 times the stencil and 100 times the depth.
fn aspects(gpu: &Gpu, fill: impl FnOnce(&mut Frame<'_>, &mut Texture)) -> wgpu::Texture {
    let read = gpu.draw("aspects", NUMBERS);
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut depth = depth(&mut frame, Format::Depth24PlusStencil8);
    fill(&mut frame, &mut depth);
    let mut color = frame.create_texture("color", square(8));
    let mut pass = frame.render_pass("read");
    let tokens = [Aspect::Depth, Aspect::Stencil].map(|which| pass.subresource(aspect(which)).sample(&depth));
    pass.color(&mut color, Contents::Overwrite);
    pass.body(|ctx| read.record(ctx, &tokens.map(Bind::Texture)));
    let color = frame.export_texture(&color);
    gpu.run(&mut graph, frame).texture(color).unwrap().clone()
}

#[test]
fn depth_is_tested_and_sampled_in_one_pass() {
    for gpu in Gpu::all() {
        let format = Format::Depth32Float;
        let fill = depth_test(format, wgpu::CompareFunction::Always, true);
        let fill = gpu.draw_with("seven", NUMBERS.into(), Some(fill), 1);
        let read = depth_test(format, wgpu::CompareFunction::Equal, false);
        let read = gpu.draw_with("hundredths", NUMBERS.into(), Some(read), 1);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let (mut depth, mut unread) = (depth(&mut frame, format), frame.create_texture("unread", square(8)));
        let mut pass = frame.render_pass("fill");
        pass.color(&mut unread, Contents::Overwrite);
        pass.depth(&mut depth, Contents::clear_depth(0.25));
        pass.body(|ctx| {
            ctx.pass.set_scissor_rect(0, 0, 4, 8);
            fill.record_without_bindings(ctx);
            Ok(())
        });
        let mut color = frame.create_texture("color", square(8));
        let mut pass = frame.render_pass("read");
        pass.depth_read(&depth);
        let token = pass.sample(&depth);
        pass.color(&mut color, Contents::clear_color([1.0, 0.0, 0.0, 0.0]));
        pass.body(|ctx| read.record(ctx, &[Bind::Texture(token)]));
        let color = frame.export_texture(&color);
        let executed = gpu.run(&mut graph, frame);
        if gpu.draws {
            let texels = gpu.texels(executed.texture(color).unwrap(), 0, 0);
            assert_eq!(texels[..8], [50, 50, 50, 50, 1, 1, 1, 1]);
        }
    }
}

#[test]
fn depth_and_stencil_are_bound_as_aspects() {
    for gpu in Gpu::all() {
        let read = aspects(&gpu, |frame, depth| {
            frame.render_pass("fill").depth(depth, Contents::clear_depth_stencil(0.75, 3));
        });
        gpu.assert_filled(&read, 3075);
    }
}

#[test]
fn each_aspect_is_cleared_by_a_separate_pass() {
    for gpu in Gpu::all() {
        let read = aspects(&gpu, |frame, depth| {
            let contents = Contents::clear_depth_stencil(0.5, 9);
            frame.render_pass("depth").subresource(aspect(Aspect::Depth)).depth(depth, contents);
            frame.render_pass("stencil").subresource(aspect(Aspect::Stencil)).depth(depth, contents);
        });
        gpu.assert_filled(&read, 9050);
    }
}

#[test]
fn depth_that_one_pass_needs_is_a_transient_attachment() {
    for gpu in Gpu::all() {
        for (format, which) in [
            (Format::Depth32Float, Aspect::All),
            (Format::Depth24PlusStencil8, Aspect::All),
            (Format::Depth24PlusStencil8, Aspect::Depth),
            (Format::Stencil8, Aspect::All),
        ] {
            for transient_attachments in [true, false] {
                let mut graph = Graph::new();
                let mut frame = graph.frame();
                frame.set_options(crate::Options { transient_attachments, ..Default::default() });
                let mut color = frame.create_texture("color", square(8));
                let mut depth = depth(&mut frame, format);
                let mut pass = frame.render_pass("draw");
                pass.color(&mut color, Contents::clear_color([2.0, 0.0, 0.0, 0.0]));
                pass.subresource(aspect(which)).depth(&mut depth, Contents::clear_depth(0.0));
                let color = frame.export_texture(&color);
                let executed = gpu.run(&mut graph, frame);
                gpu.assert_filled(executed.texture(color).unwrap(), 2);
                let usage = executed.plan().resource(depth.id()).texture_usage;
                let transient = usage.contains(wgpu::TextureUsages::TRANSIENT_ATTACHMENT);
                assert_eq!(transient, transient_attachments && which == Aspect::All, "{format:?}, {which:?}");
            }
        }
    }
}

#[test]
fn a_tile_of_one_aspect_is_cleared_and_the_other_aspect_is_kept() {
    for gpu in Gpu::all() {
        for which in [Aspect::Depth, Aspect::Stencil, Aspect::All] {
            let read = aspects(&gpu, |frame, depth| {
                frame.render_pass("all").depth(depth, Contents::clear_depth_stencil(0.5, 9));
                let tile = aspect(which).rect(Rect::new(0, 0, 4, 8));
                frame
                    .render_pass("tile")
                    .subresource(tile)
                    .depth(depth, Contents::clear_depth_stencil(0.25, 3));
            });
            if gpu.draws {
                let inside = match which {
                    Aspect::Depth => 9025,
                    Aspect::Stencil => 3050,
                    Aspect::All => 3025,
                };
                let texels = gpu.texels(&read, 0, 0);
                assert_eq!(texels[..8], [[inside; 4], [9050; 4]].concat(), "{which:?}");
            }
        }
    }
}
