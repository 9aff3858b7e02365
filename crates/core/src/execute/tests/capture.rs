//! Captures of what passes write.

use super::gpu::Gpu;
use crate::capture::{TexelValues, TextureSnapshot};
use crate::test_device::valid;
use crate::{Contents, Format, Frame, FrameCapture, Graph, Plan, Rect, Subresource, TextureDesc};

fn small() -> TextureDesc {
    TextureDesc::d2(8, 8, Format::Rgba8Unorm)
}

fn gray(value: f64) -> Contents {
    Contents::clear_color([value; 4])
}

fn capture<'f>(gpu: &'f Gpu, declare: impl Fn(&mut Frame<'f>)) -> (Plan, FrameCapture) {
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    declare(&mut frame);
    let mut encoder = gpu.encoder();
    let captured = valid(&gpu.device, || {
        let compiled = graph.compile(frame).unwrap();
        let (executed, capture) = compiled.execute_captured(&mut graph, &gpu.device, &mut encoder).unwrap();
        gpu.queue.submit([encoder.finish()]);
        (executed.plan().clone(), capture.wait(&gpu.device).unwrap())
    });
    let mut plain = Graph::new();
    let mut frame = plain.frame();
    declare(&mut frame);
    assert_eq!(captured.0, plain.compile(frame).unwrap().into_plan(), "the plan is the frame's own");
    captured
}

/// Returns the first value of a snapshot's first texel and of its last.
fn ends(snapshot: &TextureSnapshot) -> [f32; 2] {
    let texels = snapshot.texels.as_ref().unwrap();
    let number = |index: usize| match &texels.values {
        TexelValues::Bytes(bytes) => bytes[index].into(),
        TexelValues::Floats(floats) => floats[index],
    };
    let count = (texels.size_px[0] * texels.size_px[1] * texels.channels) as usize;
    [number(0), number(count - texels.channels as usize)]
}

#[test]
fn every_version_of_a_texture_has_a_snapshot_after_the_pass_that_wrote_it() {
    for gpu in Gpu::all() {
        let (plan, captured) = capture(&gpu, |frame| {
            let mut scene = frame.create_texture("scene", small());
            frame.render_pass("first").color(&mut scene, gray(0.2));
            // Merged with the first pass without the capture.
            frame.render_pass("second").color(&mut scene, Contents::Preserve);
            frame.render_pass("third").color(&mut scene, gray(0.6));
            let mut never_read = frame.create_texture("never read", small());
            let mut pass = frame.render_pass("kept");
            pass.color(&mut never_read, gray(1.0));
            pass.keep();
            frame.export_texture(&scene);
        });
        let seen: Vec<_> = captured
            .textures
            .iter()
            .map(|p| (plan.resource(p.resource).name, p.version, plan.pass(p.pass.unwrap()).name))
            .collect();
        // `third` clears the results of the passes before it, so they are culled.
        assert!(
            seen.contains(&("scene", 3, "third")) && seen.contains(&("never read", 1, "kept")),
            "{seen:?}"
        );
        assert_eq!(seen.len(), plan.order().len());
        if gpu.draws {
            let third = captured.textures.iter().find(|snapshot| snapshot.version == 3).unwrap();
            assert_eq!(ends(third), [153.0, 153.0]);
        }
    }
}

#[test]
fn a_pass_that_draws_over_another_has_a_separate_snapshot() {
    let Some(gpu) = Gpu::drawing() else { return };
    let white = gpu.draw("white", Format::Rgba8Unorm);
    let (plan, captured) = capture(&gpu, |frame| {
        let mut scene = frame.create_texture("scene", small());
        frame.render_pass("clear").color(&mut scene, gray(0.2));
        let mut pass = frame.render_pass("draw");
        pass.color(&mut scene, Contents::Preserve);
        let white = &white;
        pass.body(move |ctx| {
            ctx.pass.set_scissor_rect(4, 4, 4, 4);
            white.record_without_bindings(ctx);
            Ok(())
        });
        frame.export_texture(&scene);
    });
    assert_eq!(plan.steps().len(), 1, "merged as without the capture");
    let [cleared, drawn] = &captured.textures[..] else { panic!("{captured:?}") };
    assert_eq!((ends(cleared), ends(drawn)), ([51.0, 51.0], [51.0, 255.0]));
}

#[test]
fn tiles_are_shown_together_with_the_names_of_their_passes() {
    for gpu in Gpu::all() {
        let (_, captured) = capture(&gpu, |frame| {
            let mut atlas = frame.create_texture("atlas", TextureDesc::d2(16, 8, Format::Depth32Float));
            frame.render_pass("clear").depth(&mut atlas, Contents::clear_depth(0.0));
            for (name, x, depth) in [("left", 0, 0.25), ("right", 8, 0.5)] {
                let tile = Subresource::FULL.rect(Rect::new(x, 0, 8, 8));
                frame.render_pass(name).subresource(tile).depth(&mut atlas, Contents::clear_depth(depth));
            }
            frame.export_texture(&atlas);
        });
        let last = captured.textures.last().unwrap();
        let names: Vec<_> = last.tiles.iter().map(|tile| (&*tile.name, tile.rect.x)).collect();
        assert_eq!(names, [("left", 0), ("right", 8)]);
        assert!(captured.textures.iter().filter(|p| !p.tiles.is_empty()).count() == 1, "one for both tiles");
        if gpu.draws {
            assert_eq!(ends(last), [0.25, 0.5]);
            assert!(last.texels.as_ref().unwrap().is_depth);
        }
    }
}

#[test]
fn mips_and_layers_have_separate_snapshots() {
    for gpu in Gpu::all() {
        let (_, captured) = capture(&gpu, |frame| {
            let desc = TextureDesc { mip_levels: 2, ..small().layers(2) };
            let mut texture = frame.create_texture("texture", desc);
            for (number, (mip, layer)) in [(0, 0), (1, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                let mut pass = frame.render_pass("clear");
                pass.subresource(Subresource::FULL.mip(mip).layer(layer))
                    .color(&mut texture, gray(number as f64 / 5.0));
            }
            frame.export_texture(&texture);
        });
        let parts: Vec<_> =
            captured.textures.iter().map(|p| (p.subresource.to_string(), p.full_px)).collect();
        let whole = |layer| (format!("mip 0, layer {layer}"), [8, 8]);
        let half = |layer| (format!("mip 1, layer {layer}"), [4, 4]);
        assert_eq!(parts, [whole(0), half(0), whole(1), half(1)]);
        if gpu.draws {
            assert_eq!(
                captured.textures.iter().map(|p| ends(p)[0]).collect::<Vec<_>>(),
                [0.0, 51.0, 102.0, 153.0]
            );
        }
    }
}

#[test]
fn a_texture_that_cannot_be_copied_has_a_reason_instead() {
    for gpu in Gpu::all() {
        let (_, captured) = capture(&gpu, |frame| {
            let mut samples = frame.create_texture("samples", TextureDesc { samples: 4, ..small() });
            let mut resolved = frame.create_texture("resolved", small());
            let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth24Plus));
            let mut pass = frame.render_pass("draw");
            pass.color(&mut samples, gray(0.4));
            pass.resolve(&mut resolved);
            frame.render_pass("depth").depth(&mut depth, Contents::clear_depth(0.0));
            frame.export_texture(&resolved);
            frame.export_texture(&depth);
        });
        let [samples, resolved, depth] = &captured.textures[..] else { panic!("{captured:?}") };
        assert!(samples.texels.as_ref().is_err_and(|why| why.contains("4 samples")));
        assert!(resolved.texels.is_ok());
        assert!(depth.texels.as_ref().is_err_and(|why| why.contains("Depth32Float")), "{depth:?}");
    }
}

#[test]
fn combined_depth_and_stencil_are_captured_as_depth() {
    let Some(gpu) = Gpu::drawing() else { return };
    if !gpu.device.features().contains(wgpu::Features::DEPTH32FLOAT_STENCIL8) {
        return;
    }
    let (_, captured) = capture(&gpu, |frame| {
        let mut depth = frame.create_texture("depth", TextureDesc::d2(8, 8, Format::Depth32FloatStencil8));
        frame.render_pass("clear").depth(&mut depth, Contents::clear_depth_stencil(0.75, 3));
        frame.export_texture(&depth);
    });
    assert_eq!(ends(&captured.textures[0]), [0.75, 0.75]);
}

#[test]
fn small_buffers_are_captured_with_their_bytes() {
    for gpu in Gpu::all() {
        let (plan, captured) = capture(&gpu, |frame| {
            let bytes = frame.upload_buffer("bytes", &[1u8, 2, 3, 4][..]);
            frame.export_buffer(&bytes);
        });
        let [(id, bytes)] = &captured.buffers[..] else { panic!("{captured:?}") };
        assert_eq!((plan.resource(*id).name, &bytes[..]), ("bytes", &[1, 2, 3, 4][..]));
    }
}
