//! Bodies that fail, and the state after a frame that failed.

use super::gpu::{Gpu, NUMBERS, square};
use crate::test_text::without_places;
use crate::{Contents, Encoding, Error, Frame, Graph, Pass, TextureExport};
use std::panic::{AssertUnwindSafe, catch_unwind};

#[test]
fn an_undeclared_access_in_a_body_fails_the_frame_by_name() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut a = frame.create_texture("a", square(8));
    let token = frame.render_pass("first").color(&mut a, Contents::clear_color([0.0; 4]));
    let mut second = frame.encoder_pass("second");
    second.keep();
    second.body(move |ctx| ctx.view(token).map(|_| ()));
    frame.export_texture(&a);
    let error = gpu.try_run(&mut graph, frame).err().unwrap();
    assert!(
        matches!(&error, Error::Undeclared { pass, resource, .. } if pass.path() == "second" && resource == "a"),
        "{error}"
    );
}

#[test]
fn frames_that_share_a_plan_have_their_own_places() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let declare: [fn(&mut Frame<'_>); 2] =
        [|frame| fail(frame.encoder_pass("draw")), |frame| fail(frame.encoder_pass("draw"))];
    let columns = declare.map(|declare| {
        let mut frame = graph.frame();
        declare(&mut frame);
        let Err(Error::Body { pass, .. }) = gpu.try_run(&mut graph, frame) else { panic!("a body fails") };
        pass.declared_at().unwrap().column()
    });
    assert_eq!(graph.plan_counts().reused, 1);
    assert!(columns[0] < columns[1], "{columns:?}");
}

fn fail(mut pass: Pass<'_, '_, Encoding>) {
    pass.keep();
    pass.body(|_| Err(Error::body("spilt")));
}

#[test]
fn a_token_or_block_of_another_frame_fails_the_frame() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let mut other = graph.frame();
    let mut a = other.create_texture("a", square(8));
    let token = other.render_pass("other").color(&mut a, Contents::Overwrite);
    let block = other.uniform(&[0; 16]);
    let layout =
        gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[] });
    for uniform in [false, true] {
        let mut frame = graph.frame();
        let mut pass = frame.encoder_pass("pass");
        pass.keep();
        let layout = &layout;
        pass.body(move |ctx| match uniform {
            true => ctx.bind_group(layout, &[crate::Bind::Uniform(block)]).map(|_| ()),
            false => ctx.texture(token).map(|_| ()),
        });
        let error = gpu.try_run(&mut graph, frame).err().unwrap();
        assert!(
            matches!(&error, Error::ForeignHandle { location } if location.starts_with("pass `pass` (")),
            "{error}"
        );
    }
}

#[test]
fn an_import_without_an_object_fails_the_frame_by_name() {
    let gpu = Gpu::noop();
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    let mut screen = frame.declare_import_texture("screen", square(8), usage, false);
    frame.render_pass("draw").color(&mut screen, Contents::clear_color([0.0; 4]));
    let error = gpu.try_run(&mut graph, frame).err().unwrap();
    assert_eq!(error, Error::NoImport { resource: "screen".into() });
}

#[test]
fn a_body_of_any_kind_fails_with_the_name_of_its_pass_and_node() {
    let gpu = Gpu::noop();
    let fail = || Err(Error::body("no more paint"));
    for kind in 0..3 {
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut a = frame.create_texture("a", square(8));
        frame.node("effects", |frame| match kind {
            0 => {
                let mut pass = frame.render_pass("glow");
                pass.color(&mut a, Contents::clear_color([0.0; 4]));
                pass.keep();
                pass.body(move |_| fail());
            }
            1 => {
                let mut pass = frame.compute_pass("glow");
                pass.keep();
                pass.body(move |_| fail());
            }
            _ => {
                let mut pass = frame.encoder_pass("glow");
                pass.keep();
                pass.body(move |_| fail());
            }
        });
        let error = gpu.try_run(&mut graph, frame).err().unwrap();
        assert_eq!(without_places(&error), "SG0602: pass `effects/glow`: no more paint");
    }
}

/// Failure of the second of two merged passes.
#[derive(Clone, Copy, Debug)]
enum Fault {
    None,
    Error,
    Panic,
}

/// Declares two passes that share a render pass; the second writes 7 unless it fails.
fn frame<'f>(graph: &Graph, draw: &'f super::Draw, fault: Fault) -> (Frame<'f>, TextureExport) {
    let mut frame = graph.frame();
    let mut a = frame.create_texture("a", square(8));
    frame.render_pass("clear").color(&mut a, Contents::clear_color([3.0, 0.0, 0.0, 0.0]));
    let mut pass = frame.render_pass("draw");
    pass.color(&mut a, Contents::Preserve);
    pass.body(move |ctx| {
        draw.record_without_bindings(ctx);
        match fault {
            Fault::None => Ok(()),
            Fault::Error => Err(Error::body("spilt")),
            Fault::Panic => panic!("the panic of a body, which this test is about"),
        }
    });
    let a = frame.export_texture(&a);
    (frame, a)
}

#[test]
fn after_a_body_failed_or_panicked_the_next_frame_is_as_before() {
    for gpu in Gpu::all() {
        let draw = gpu.draw("seven", NUMBERS);
        for threads in [None, Some(2)] {
            let mut graph = Graph::new();
            let (before, a) = frame(&graph, &draw, Fault::None);
            let before = gpu.run(&mut graph, before).texture(a).unwrap().clone();
            for fault in [Fault::Error, Fault::Panic] {
                let (failing, _) = frame(&graph, &draw, fault);
                let record = AssertUnwindSafe(|| {
                    let compiled = graph.compile(failing).unwrap();
                    match threads {
                        None => compiled.execute(&mut graph, &gpu.device, &mut gpu.encoder()).err(),
                        Some(n) => compiled.execute_on_threads(&mut graph, &gpu.device, n).err(),
                    }
                });
                let outcome = catch_unwind(record).map(|error| without_places(&error.unwrap()));
                match fault {
                    Fault::Panic => assert!(outcome.is_err(), "a panic is propagated"),
                    _ => assert_eq!(outcome.unwrap(), "SG0602: pass `draw`: spilt"),
                }
                let (after, a) = frame(&graph, &draw, Fault::None);
                let after = gpu.run(&mut graph, after);
                assert_eq!(after.plan().steps().len(), 1);
                assert_eq!(*after.texture(a).unwrap(), before, "{fault:?}, {threads:?}");
                gpu.assert_filled(&before, 7);
            }
        }
    }
}

#[test]
fn unsupported_formats_are_errors_of_the_graph() {
    use crate::Format;
    let storage = [
        Format::Rgba8UnormSrgb,
        Format::R8Unorm,
        Format::Bgra8Unorm,
        Format::Rg11b10Ufloat,
        Format::R16Unorm,
        Format::Bc1RgbaUnorm,
    ];
    let drawn = [
        (Format::Rgb9e5Ufloat, 1),
        (Format::R16Unorm, 1),
        (Format::Rgba8Unorm, 2),
        (Format::Rgba8Unorm, 8),
        (Format::Rgba32Float, 4),
    ];
    for gpu in Gpu::all() {
        let check = |format: Format, samples: u32, storage: bool| {
            let mut graph = Graph::new();
            let mut frame = graph.frame();
            let desc = crate::TextureDesc { format, samples, ..square(8) };
            let mut image = frame.create_texture("image", desc);
            if storage {
                frame.compute_pass("store").storage_texture_mut(&mut image, Contents::Overwrite);
            } else {
                frame.render_pass("draw").color(&mut image, Contents::clear_color([0.0; 4]));
            }
            frame.export_texture(&image);
            let error = gpu.try_run(&mut graph, frame).err();
            assert_eq!(error.as_ref().map(Error::code), Some("SG0605"), "{format:?} x {samples}: {error:?}");
        };
        // Driver-specific formats are not guaranteed, so the tests' device does not request them.
        for format in storage {
            check(format, 1, true);
        }
        for (format, samples) in drawn {
            check(format, samples, false);
        }
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let desc = crate::TextureDesc { format: Format::Rgba16Float, ..square(8) };
        let mut targets = [(); 5].map(|()| frame.create_texture("target", desc));
        let mut pass = frame.render_pass("draw");
        for target in &mut targets {
            pass.color(target, Contents::clear_color([0.0; 4]));
        }
        frame.export_texture(&targets[0]);
        let error = gpu.try_run(&mut graph, frame).err().unwrap().to_string();
        assert!(
            error.starts_with("SG0601") && error.contains("max_color_attachment_bytes_per_sample"),
            "{error}"
        );
    }
}
