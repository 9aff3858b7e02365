//! Multisampled attachments.

use super::gpu::{Gpu, depth_test};
use crate::{Contents, Format, Graph, TextureDesc};

const COLORS: Format = Format::Rgba8Unorm;

#[test]
fn a_multisampled_attachment_is_resolved_and_never_stored() {
    for gpu in Gpu::all() {
        let depth_format = Format::Depth32Float;
        let depth = depth_test(depth_format, wgpu::CompareFunction::Greater, true);
        let draw = gpu.draw_with("white", COLORS.into(), Some(depth), 4);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let samples = |format| TextureDesc { samples: 4, ..TextureDesc::d2(8, 8, format) };
        let mut color = frame.create_texture("color", samples(COLORS));
        let mut depth = frame.create_texture("depth", samples(depth_format));
        let mut resolved = frame.create_texture("resolved", TextureDesc::d2(8, 8, COLORS));
        let mut pass = frame.render_pass("draw");
        pass.color(&mut color, Contents::clear_color([0.0, 0.0, 0.0, 1.0]));
        pass.resolve(&mut resolved);
        pass.depth(&mut depth, Contents::clear_depth(0.0));
        pass.body(|ctx| {
            ctx.pass.set_scissor_rect(0, 0, 8, 4);
            draw.record_without_bindings(ctx);
            Ok(())
        });
        let resolved = frame.export_texture(&resolved);
        let executed = gpu.run(&mut graph, frame);
        for id in [color.id(), depth.id()] {
            let usage = executed.plan().resource(id).texture_usage;
            assert!(usage.contains(wgpu::TextureUsages::TRANSIENT_ATTACHMENT));
        }
        if gpu.draws {
            let texels = gpu.texels(executed.texture(resolved).unwrap(), 0, 0);
            assert_eq!(texels[..32], [u32::MAX; 32]);
            assert_eq!(texels[32..], [0xff00_0000; 32]);
        }
    }
}

#[test]
fn merged_passes_resolve_once_at_the_end() {
    for gpu in Gpu::all() {
        let draw = gpu.draw_with("white", COLORS.into(), None, 4);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let samples = TextureDesc { samples: 4, ..TextureDesc::d2(8, 8, COLORS) };
        let mut color = frame.create_texture("color", samples);
        let mut resolved = frame.create_texture("resolved", TextureDesc::d2(8, 8, COLORS));
        frame.render_pass("clear").color(&mut color, Contents::clear_color([0.0; 4]));
        let mut pass = frame.render_pass("draw");
        pass.color(&mut color, Contents::Preserve);
        pass.resolve(&mut resolved);
        pass.body(|ctx| {
            ctx.pass.set_scissor_rect(0, 0, 8, 2);
            draw.record_without_bindings(ctx);
            Ok(())
        });
        let resolved = frame.export_texture(&resolved);
        let executed = gpu.run(&mut graph, frame);
        assert_eq!(executed.plan().steps().len(), 1);
        if gpu.draws {
            let texels = gpu.texels(executed.texture(resolved).unwrap(), 0, 0);
            assert_eq!(texels[8..24], [[u32::MAX; 8], [0; 8]].concat());
        }
    }
}

#[test]
fn a_multisampled_attachment_that_is_drawn_on_after_a_resolve_keeps_its_samples() {
    for gpu in Gpu::all() {
        let draw = gpu.draw_with("white", COLORS.into(), None, 4);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let samples = TextureDesc { samples: 4, ..TextureDesc::d2(8, 8, COLORS) };
        let mut color = frame.create_texture("color", samples);
        let mut resolved = [0, 1].map(|_| frame.create_texture("resolved", TextureDesc::d2(8, 8, COLORS)));
        for (row, resolved) in (0..).zip(&mut resolved) {
            let mut pass = frame.render_pass("draw");
            pass.color(
                &mut color,
                if row == 0 { Contents::clear_color([0.0; 4]) } else { Contents::Preserve },
            );
            pass.resolve(resolved);
            let draw = &draw;
            pass.body(move |ctx| {
                ctx.pass.set_scissor_rect(0, row, 8, 1);
                draw.record_without_bindings(ctx);
                Ok(())
            });
        }
        let resolved = resolved.map(|resolved| frame.export_texture(&resolved));
        let executed = gpu.run(&mut graph, frame);
        assert_eq!(executed.plan().steps().len(), 2);
        if !gpu.draws {
            continue;
        }
        let rows = resolved.map(|resolved| {
            let texels = gpu.texels(executed.texture(resolved).unwrap(), 0, 0);
            texels.chunks(8).filter(|row| *row == [u32::MAX; 8]).count()
        });
        assert_eq!(rows, [1, 2]);
    }
}
