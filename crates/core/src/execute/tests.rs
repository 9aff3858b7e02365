//! Recording on wgpu's noop device with default limits: everything is validated, nothing is drawn.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use crate::{Bind, BufferDesc, Contents, Error, Executed, Format, Frame, Pool, TextureDesc, Timer};
use std::sync::atomic::{AtomicU32, Ordering};

fn noop() -> (wgpu::Device, wgpu::Queue) {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends: wgpu::Backends::NOOP,
        backend_options: wgpu::BackendOptions {
            noop: wgpu::NoopBackendOptions { enable: true, ..Default::default() },
            ..Default::default()
        },
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())).unwrap();
    block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits::default(),
        ..Default::default()
    }))
    .unwrap()
}

/// The noop backend's futures are ready at once.
fn block_on<F: Future>(future: F) -> F::Output {
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    match std::pin::pin!(future).poll(&mut context) {
        std::task::Poll::Ready(output) => output,
        std::task::Poll::Pending => panic!("the noop backend waits for nothing"),
    }
}

/// Records and submits under an error scope.
fn run(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    pool: &mut Pool,
    frame: Frame<'_>,
) -> Result<Executed, Error> {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let mut encoder = device.create_command_encoder(&Default::default());
    let executed = frame.compile()?.execute(pool, device, &mut encoder);
    if executed.is_ok() {
        queue.submit([encoder.finish()]);
    }
    if let Some(error) = block_on(scope.pop()) {
        panic!("{error}");
    }
    executed
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Depth,
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            },
            wgpu::BindGroupLayoutEntry {
                binding: 1,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only: true },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            },
        ],
    })
}

/// A frame with an upload, depth, a bind group and a copy; `bodies` counts the bodies that ran.
fn sample_frame<'f>(layout: &'f wgpu::BindGroupLayout, bodies: &'f AtomicU32, size: u32) -> Frame<'f> {
    let mut frame = Frame::new();
    let numbers = frame.upload_buffer("numbers", &[1u8, 2, 3, 4, 5][..]);
    let mut depth = frame.create_texture("depth", TextureDesc::d2(size, size, Format::Depth24PlusStencil8));
    frame.render_pass("depth").depth(&mut depth, Contents::clear_depth(0.0));
    let mut color = frame.create_texture("color", TextureDesc::d2(size, size, Format::Rgba8Unorm));
    let mut pass = frame.render_pass("color");
    let (depth, numbers) = (pass.sample(&depth), pass.storage_buffer(&numbers));
    pass.color(&mut color, Contents::Cover);
    pass.body(move |ctx| {
        let group = ctx.bind_group(layout, &[Bind::Texture(depth), Bind::Buffer(numbers)])?;
        ctx.pass.set_bind_group(0, &group, &[]);
        bodies.fetch_add(1, Ordering::Relaxed);
        Ok(())
    });
    let mut copy = frame.create_texture("copy", TextureDesc::d2(size, size, Format::Rgba8Unorm));
    let mut bytes = frame.create_buffer("bytes", BufferDesc::new(u64::from(size.max(64) * size * 4)));
    frame.copy_pass("copies").texture(&color, &mut copy);
    frame.copy_pass("back").texture_to_buffer(&copy, &mut bytes);
    frame.export_buffer(&bytes);
    frame
}

#[test]
fn a_frame_of_every_kind_of_pass_records_without_validation_errors() {
    let (device, queue) = noop();
    let mut pool = Pool::new();
    let (layout, bodies) = (layout(&device), AtomicU32::new(0));
    let mut frame = sample_frame(&layout, &bodies, 64);
    let mut sums = frame.create_buffer("sums", BufferDesc::new(16));
    let mut compute = frame.compute_pass("sum");
    compute.storage_buffer_mut(&mut sums, Contents::Cover);
    compute.body(|_| Ok(()));
    let mut raw = frame.encoder_pass("raw");
    let token = raw.copy_source_buffer(&sums);
    raw.keep();
    raw.body(move |ctx| {
        let buffer = ctx.buffer(token)?.clone();
        assert_eq!(buffer.size(), 16);
        ctx.encoder.insert_debug_marker("here");
        Ok(())
    });
    run(&device, &queue, &mut pool, frame).unwrap();
    assert_eq!(bodies.load(Ordering::Relaxed), 1);
}

#[test]
fn identical_frames_reuse_textures_and_bind_groups() {
    let (device, queue) = noop();
    let mut pool = Pool::new();
    let (layout, bodies) = (layout(&device), AtomicU32::new(0));
    run(&device, &queue, &mut pool, sample_frame(&layout, &bodies, 64)).unwrap();
    let bytes = pool.bytes();
    for _ in 0..20 {
        run(&device, &queue, &mut pool, sample_frame(&layout, &bodies, 64)).unwrap();
    }
    assert_eq!(pool.bytes(), bytes);
    assert_eq!(pool.bind_groups.len(), 1);
}

#[test]
fn what_lies_idle_for_eight_frames_is_dropped() {
    let (device, queue) = noop();
    let mut pool = Pool::new();
    let (layout, bodies) = (layout(&device), AtomicU32::new(0));
    run(&device, &queue, &mut pool, sample_frame(&layout, &bodies, 256)).unwrap();
    let large = pool.bytes();
    for _ in 0..10 {
        run(&device, &queue, &mut pool, sample_frame(&layout, &bodies, 64)).unwrap();
    }
    assert!(pool.bytes() < large / 4, "{} of {large}", pool.bytes());
    assert_eq!(pool.bind_groups.len(), 1);
}

#[test]
fn an_undeclared_access_in_a_body_fails_the_frame_by_name() {
    let (device, queue) = noop();
    let mut frame = Frame::new();
    let mut a = frame.create_texture("a", TextureDesc::d2(8, 8, Format::Rgba8Unorm));
    let mut first = frame.render_pass("first");
    let token = first.color(&mut a, Contents::clear_color([0.0; 4]));
    let mut second = frame.encoder_pass("second");
    second.keep();
    second.body(move |ctx| ctx.view(token).map(|_| ()));
    frame.export_texture(&a);
    let error = run(&device, &queue, &mut Pool::new(), frame).err().unwrap();
    assert!(
        matches!(&error, Error::Undeclared { pass, resource, .. } if pass == "second" && resource == "a")
    );
}

#[test]
fn a_texture_over_the_limits_is_an_error_that_names_the_limit() {
    let (device, queue) = noop();
    let mut frame = Frame::new();
    let mut a = frame.create_texture("huge", TextureDesc::d2(100_000, 8, Format::Rgba8Unorm));
    frame.render_pass("draw").color(&mut a, Contents::clear_color([0.0; 4]));
    frame.export_texture(&a);
    let error = run(&device, &queue, &mut Pool::new(), frame).err().unwrap().to_string();
    assert!(error.contains("`huge` needs 100000 (max_texture_dimension_2d)"), "{error}");
}

#[test]
fn a_body_of_the_callers_fails_with_the_pass_name() {
    let (device, queue) = noop();
    let mut frame = Frame::new();
    let mut pass = frame.encoder_pass("effect");
    pass.keep();
    pass.body(|_| Err(Error::body("no more paint")));
    let error = run(&device, &queue, &mut Pool::new(), frame).err().unwrap().to_string();
    assert_eq!(error, "pass `effect`: no more paint");
}

#[test]
fn an_export_is_taken_out_and_an_import_drawn_into() {
    let (device, queue) = noop();
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 16, height: 16, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let mut frame = Frame::new();
    let mut out = frame.import_texture("target", &target, false);
    frame.render_pass("clear").color(&mut out, Contents::clear_color([1.0; 4]));
    let mut own = frame.create_texture("own", TextureDesc::d2(4, 4, Format::R8Unorm));
    frame.render_pass("own").color(&mut own, Contents::clear_color([1.0; 4]));
    let export = frame.export_texture(&own);
    let executed = run(&device, &queue, &mut Pool::new(), frame).unwrap();
    assert_eq!(executed.texture(export).unwrap().width(), 4);
}

#[test]
fn a_timed_frame_has_a_time_for_every_pass() {
    let (device, queue) = noop();
    let (layout, bodies) = (layout(&device), AtomicU32::new(0));
    let (mut pool, mut timer) = (Pool::new(), Timer::new());
    let mut encoder = device.create_command_encoder(&Default::default());
    let frame = sample_frame(&layout, &bodies, 64).compile().unwrap();
    let executed = frame.execute_timed(&mut pool, &device, &mut encoder, &mut timer).unwrap();
    queue.submit([encoder.finish()]);
    let times = timer.read(&device, &queue, executed.plan()).unwrap();
    assert_eq!(times.len(), executed.plan().live_passes().count());
    assert!(times.iter().all(|time| time.cpu_ms >= 0.0));
}
