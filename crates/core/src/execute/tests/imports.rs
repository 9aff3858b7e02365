//! Imports of the caller's textures and buffers.

use super::gpu::{Gpu, NUMBERS, square};
use crate::test_device::{block_on, valid};
use crate::{Bind, Contents, Error, Graph};
use wgpu::TextureUsages as Usage;

#[test]
fn an_import_is_drawn_into_and_kept_where_the_frame_preserves_it() {
    for gpu in Gpu::all() {
        let target = gpu.texture(square(8), Usage::RENDER_ATTACHMENT | Usage::COPY_SRC);
        let draw = gpu.draw("seven", NUMBERS);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut out = frame.import_texture("target", &target, false);
        frame.render_pass("clear").color(&mut out, Contents::clear_color([4.0, 0.0, 0.0, 0.0]));
        gpu.run(&mut graph, frame);
        gpu.assert_filled(&target, 4);
        let mut frame = graph.frame();
        let mut out = frame.import_texture("target", &target, true);
        let mut pass = frame.render_pass("draw");
        pass.color(&mut out, Contents::Preserve);
        pass.body(|ctx| {
            ctx.pass.set_scissor_rect(0, 0, 8, 1);
            draw.record_without_bindings(ctx);
            Ok(())
        });
        let export = frame.export_texture(&out);
        let executed = gpu.run(&mut graph, frame);
        assert_eq!(*executed.texture(export).unwrap(), target);
        if gpu.draws {
            assert_eq!(gpu.texels(&target, 0, 0)[..16], [[7; 8], [4; 8]].concat());
        }
        assert_eq!(graph.bytes(), 0);
    }
}

#[test]
fn an_import_may_be_another_texture_in_each_frame() {
    for gpu in Gpu::all() {
        let targets = [0, 1, 2].map(|_| gpu.texture(square(8), Usage::RENDER_ATTACHMENT | Usage::COPY_SRC));
        let mut graph = Graph::new();
        for (target, n) in targets.iter().zip([5u32, 6, 7]).cycle().take(7) {
            let mut frame = graph.frame();
            let mut out = frame.import_texture("target", target, false);
            let value = Contents::clear_color([f64::from(n), 0.0, 0.0, 0.0]);
            frame.render_pass("clear").color(&mut out, value);
            gpu.run(&mut graph, frame);
        }
        for (target, number) in targets.iter().zip([5, 6, 7]) {
            gpu.assert_filled(target, number);
        }
    }
}

#[test]
fn an_imported_buffer_is_read_and_written() {
    for gpu in Gpu::all() {
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 16,
            usage,
            mapped_at_creation: false,
        });
        gpu.queue.write_buffer(&buffer, 0, &[1; 16]);
        let mut graph = Graph::new();
        let mut frame = graph.frame();
        let mut own = frame.import_buffer("own", &buffer, true);
        let mut copy = frame.create_buffer("copy", crate::BufferDesc::new(16));
        frame.copy_pass("out").buffer(&own, &mut copy);
        let upload = frame.upload_buffer("upload", &[2; 16][..]);
        frame.copy_pass("in").buffer(&upload, &mut own);
        let copy = frame.export_buffer(&copy);
        let executed = gpu.run(&mut graph, frame);
        assert_eq!(gpu.words(executed.buffer(copy).unwrap()), [0x0101_0101; 4]);
        assert_eq!(gpu.words(&buffer), [0x0202_0202; 4]);
    }
}

#[test]
fn an_import_without_the_usage_that_a_pass_needs_is_an_error_that_names_it() {
    let gpu = Gpu::noop();
    let target = gpu.texture(square(8), Usage::COPY_SRC);
    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let mut out = frame.import_texture("target", &target, false);
    frame.render_pass("draw").color(&mut out, Contents::Overwrite);
    let error = gpu.try_run(&mut graph, frame).err().unwrap();
    assert!(matches!(&error, Error::ImportUsage { needed, .. } if needed.contains("RENDER_ATTACHMENT")));
}

/// Returns wgpu's noop device, and the instance, which counts live objects.
fn counted() -> (wgpu::Instance, Gpu) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions {
            noop: wgpu::NoopBackendOptions { enable: true, ..Default::default() },
            ..Default::default()
        },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter = block_on(instance.request_adapter(&Default::default())).unwrap();
    let device = block_on(adapter.request_device(&Default::default())).unwrap();
    (instance, Gpu::new(device, false))
}

/// Returns the numbers of live textures and views.
fn live_objects(instance: &wgpu::Instance) -> (usize, usize) {
    let hub = instance.generate_report().unwrap().hub;
    (hub.textures.num_kept_from_user, hub.texture_views.num_kept_from_user)
}

#[test]
fn nothing_of_an_import_that_was_drawn_into_is_held_after_the_frame() {
    // A surface cannot be reconfigured while its last texture or a view of it exists.
    let (instance, gpu) = counted();
    let mut graph = Graph::new();
    for _ in 0..3 {
        let before = live_objects(&instance);
        let screen = gpu.texture(square(8), Usage::RENDER_ATTACHMENT);
        let mut frame = graph.frame();
        let mut out = frame.import_texture("screen", &screen, false);
        frame.render_pass("draw").color(&mut out, Contents::clear_color([0.0; 4]));
        let executed = gpu.run(&mut graph, frame);
        assert!(live_objects(&instance) > before);
        drop((screen, executed));
        assert_eq!(live_objects(&instance), before);
    }
}

#[test]
fn an_import_may_be_destroyed_after_its_frame() {
    for gpu in Gpu::all() {
        let mut graph = Graph::new();
        for _ in 0..3 {
            let screen = gpu.texture(square(8), Usage::RENDER_ATTACHMENT);
            let mut frame = graph.frame();
            let mut out = frame.import_texture("screen", &screen, false);
            frame.render_pass("draw").color(&mut out, Contents::clear_color([0.0; 4]));
            gpu.run(&mut graph, frame);
            valid(&gpu.device, || screen.destroy());
        }
    }
}

#[test]
fn an_import_that_was_bound_is_released_with_its_bind_group() {
    let (instance, gpu) = counted();
    let draw = gpu.draw("loaded", NUMBERS);
    let mut graph = Graph::new();
    graph.set_limits(crate::PoolLimits { idle_frames: 2, ..Default::default() });
    let mut run = |image: Option<&wgpu::Texture>| {
        let mut frame = graph.frame();
        let mut color = frame.create_texture("color", square(8));
        let token = image.map(|image| frame.import_texture("image", image, true));
        let mut pass = frame.render_pass("draw");
        let token = token.map(|image| pass.sample(&image));
        pass.color(&mut color, Contents::Overwrite);
        pass.body(|ctx| match token {
            Some(token) => draw.record(ctx, &[Bind::Texture(token)]),
            None => Ok(()),
        });
        frame.export_texture(&color);
        gpu.run(&mut graph, frame);
    };
    let mut counts = Vec::new();
    for _ in 0..3 {
        let image = gpu.texture(square(8), Usage::TEXTURE_BINDING);
        run(Some(&image));
        drop(image);
        for _ in 0..3 {
            run(None);
        }
        counts.push(live_objects(&instance));
    }
    // The graph's only texture, with its view.
    assert_eq!(counts, [(1, 1); 3]);
}
