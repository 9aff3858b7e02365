//! Buffers on wgpu's noop device, textures on one that draws.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::{ReadBack, TexturePart};
use crate::Error;
use crate::test_device::{block_on, drawing, noop, valid};
use std::time::{Duration, Instant};
use wgpu::util::DeviceExt as _;
use wgpu::{Extent3d, TextureAspect, TextureFormat, TextureUsages};

const FULL: TexturePart = TexturePart { mip: 0, layers: 0..1, aspect: TextureAspect::All, rect: None };

fn encoder(device: &wgpu::Device) -> wgpu::CommandEncoder {
    device.create_command_encoder(&Default::default())
}

fn buffer(device: &wgpu::Device, contents: &[u8]) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::COPY_SRC;
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: None, contents, usage })
}

fn texture(device: &wgpu::Device, size: [u32; 3], format: TextureFormat) -> wgpu::Texture {
    device.create_texture(&description(size, format))
}

fn description(size: [u32; 3], format: TextureFormat) -> wgpu::TextureDescriptor<'static> {
    let [width, height, depth_or_array_layers] = size;
    wgpu::TextureDescriptor {
        label: None,
        size: Extent3d { width, height, depth_or_array_layers },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: TextureUsages::COPY_SRC | TextureUsages::COPY_DST | TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    }
}

fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, mip_level: u32, bytes: &[u8]) {
    let size = texture.size().mip_level_size(mip_level, texture.dimension());
    let texel = texture.format().block_copy_size(None).unwrap();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(size.width * texel),
        rows_per_image: Some(size.height),
    };
    let target = wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() };
    queue.write_texture(target, bytes, layout, size);
}

/// Records and submits the copy of a part of a texture.
fn read(device: &wgpu::Device, queue: &wgpu::Queue, texture: &wgpu::Texture, part: &TexturePart) -> ReadBack {
    let mut encoder = encoder(device);
    let back = ReadBack::texture(device, &mut encoder, "image", texture, part).unwrap();
    valid(device, || queue.submit([encoder.finish()]));
    back
}

fn texels(values: impl IntoIterator<Item = u32>) -> Vec<u8> {
    values.into_iter().flat_map(u32::to_le_bytes).collect()
}

/// Returns the error of a read-back that is not possible.
fn problem_of(
    device: &wgpu::Device,
    description: &wgpu::TextureDescriptor<'_>,
    part: &TexturePart,
) -> String {
    let texture = valid(device, || device.create_texture(description));
    let refused = ReadBack::texture(device, &mut encoder(device), "image", &texture, part);
    refused.err().unwrap().to_string()
}

#[test]
fn any_range_of_a_buffer_is_read() {
    let (device, queue) = noop();
    let contents: Vec<u8> = (0..64).collect();
    let source = buffer(&device, &contents);
    for range in [0..64, 0..1, 3..5, 5..6, 8..16, 61..64] {
        let mut encoder = encoder(&device);
        let back = ReadBack::buffer(&device, &mut encoder, "numbers", &source, range.clone()).unwrap();
        assert!(!back.is_ready());
        valid(&device, || queue.submit([encoder.finish()]));
        let expected = &contents[range.start as usize..range.end as usize];
        assert_eq!(back.wait(&device).unwrap(), expected, "{range:?}");
    }
}

#[test]
fn bytes_arrive_with_the_next_submission_without_other_calls() {
    let (device, queue) = noop();
    let mut encoder = encoder(&device);
    let source = buffer(&device, &[1, 2, 3, 4]);
    let back = ReadBack::buffer(&device, &mut encoder, "numbers", &source, 0..4).unwrap();
    queue.submit([encoder.finish()]);
    assert!(!back.is_ready());
    queue.submit([]);
    assert!(back.is_ready());
    assert_eq!(block_on(back).unwrap(), [1, 2, 3, 4]);
}

#[test]
fn ranges_outside_a_buffer_are_errors() {
    let (device, _queue) = noop();
    let source = buffer(&device, &[0; 8]);
    let problem = |source: &wgpu::Buffer, range| {
        let back = ReadBack::buffer(&device, &mut encoder(&device), "numbers", source, range);
        let error = back.err().unwrap();
        assert!(matches!(&error, Error::ReadBack { resource, .. } if resource == "numbers"), "{error:?}");
        error.to_string()
    };
    assert!(problem(&source, 4..12).contains("it has 8 bytes, but 4..12 are requested"));
    assert!(problem(&source, 4..4).contains("at least one"));
    assert!(problem(&source, u64::MAX - 1..u64::MAX).contains("it has 8 bytes"));
    let odd = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 6,
        usage: wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    assert!(problem(&odd, 4..6).contains("multiple of 4"));
    let uniforms = device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 8,
        usage: wgpu::BufferUsages::UNIFORM,
        mapped_at_creation: false,
    });
    assert!(problem(&uniforms, 0..8).contains("COPY_SRC"));
}

#[test]
fn texels_of_an_odd_width_are_tightly_packed() {
    let Some((device, queue)) = drawing() else { return };
    let image = texture(&device, [3, 2, 1], TextureFormat::Rgba8Unorm);
    let contents: Vec<u8> = (0..24).collect();
    write(&queue, &image, 0, &contents);
    assert_eq!(read(&device, &queue, &image, &FULL).wait(&device).unwrap(), contents);
}

#[test]
fn layers_follow_each_other() {
    let Some((device, queue)) = drawing() else { return };
    let layers = texture(&device, [5, 3, 4], TextureFormat::R32Uint);
    write(&queue, &layers, 0, &texels(0..60));
    let part = TexturePart { layers: 1..3, ..FULL };
    assert_eq!(read(&device, &queue, &layers, &part).wait(&device).unwrap(), texels(15..45));
}

#[test]
fn a_mip_level_has_its_own_size() {
    let Some((device, queue)) = drawing() else { return };
    let mips = device.create_texture(&wgpu::TextureDescriptor {
        mip_level_count: 3,
        ..description([7, 5, 2], TextureFormat::R32Uint)
    });
    write(&queue, &mips, 1, &texels(0..12));
    let part = TexturePart { mip: 1, layers: 1..2, ..FULL };
    assert_eq!(read(&device, &queue, &mips, &part).wait(&device).unwrap(), texels(6..12));
}

#[test]
fn slices_of_a_volume_are_read_like_layers() {
    let Some((device, queue)) = drawing() else { return };
    let volume = device.create_texture(&wgpu::TextureDescriptor {
        dimension: wgpu::TextureDimension::D3,
        usage: TextureUsages::COPY_SRC | TextureUsages::COPY_DST,
        ..description([2, 2, 3], TextureFormat::R32Uint)
    });
    write(&queue, &volume, 0, &texels(0..12));
    let part = TexturePart { layers: 1..3, ..FULL };
    assert_eq!(read(&device, &queue, &volume, &part).wait(&device).unwrap(), texels(4..12));
}

/// Clears a depth texture and reads its depth.
fn cleared_depth(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    size: [u32; 3],
    aspect: TextureAspect,
) -> ReadBack {
    let depth = texture(device, size, TextureFormat::Depth32Float);
    let view = depth.create_view(&Default::default());
    let mut encoder = encoder(device);
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.25), store: wgpu::StoreOp::Store };
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
            view: &view,
            depth_ops: Some(ops),
            stencil_ops: None,
        }),
        ..Default::default()
    }));
    let part = TexturePart { aspect, ..FULL };
    let back = ReadBack::texture(device, &mut encoder, "depth", &depth, &part).unwrap();
    valid(device, || queue.submit([encoder.finish()]));
    back
}

#[test]
fn depth_is_read_by_its_aspect() {
    let Some((device, queue)) = drawing() else { return };
    for aspect in [TextureAspect::DepthOnly, TextureAspect::All] {
        let bytes = cleared_depth(&device, &queue, [3, 3, 1], aspect).wait(&device).unwrap();
        assert_eq!(bytes, 0.25_f32.to_le_bytes().repeat(9));
    }
}

#[test]
fn a_poll_on_another_thread_wakes_the_awaiting_one() {
    let Some((device, queue)) = drawing() else { return };
    let back = cleared_depth(&device, &queue, [64, 64, 1], TextureAspect::DepthOnly);
    std::thread::scope(|scope| {
        let awaiting = scope.spawn(|| block_on(back));
        // Long enough that the other thread most likely sleeps by now.
        std::thread::sleep(Duration::from_millis(20));
        scope.spawn(|| device.poll(wgpu::PollType::wait_indefinitely()).unwrap());
        assert_eq!(awaiting.join().unwrap().unwrap(), 0.25_f32.to_le_bytes().repeat(64 * 64));
    });
}

#[test]
fn waiting_threads_may_poll_each_others_callbacks() {
    let Some((device, queue)) = drawing() else { return };
    for _ in 0..20 {
        let backs: Vec<_> =
            (0..4).map(|_| cleared_depth(&device, &queue, [16, 16, 1], TextureAspect::DepthOnly)).collect();
        std::thread::scope(|scope| {
            for back in backs {
                scope.spawn(|| assert_eq!(back.wait(&device).unwrap().len(), 16 * 16 * 4));
            }
        });
    }
}

#[test]
fn a_frame_submitted_from_another_thread_is_waited_for() {
    let (device, queue) = noop();
    let mut encoder = encoder(&device);
    let source = buffer(&device, &[1, 2, 3, 4]);
    let back = ReadBack::buffer(&device, &mut encoder, "numbers", &source, 0..4).unwrap();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(50));
            queue.submit([encoder.finish()]);
        });
        assert_eq!(back.wait(&device).unwrap(), [1, 2, 3, 4]);
    });
}

#[test]
fn a_dropped_encoder_is_an_error_and_wakes_the_awaiting_thread() {
    let (device, _queue) = noop();
    let source = buffer(&device, &[0; 4]);
    for finished in [false, true] {
        let mut encoder = encoder(&device);
        let awaited = ReadBack::buffer(&device, &mut encoder, "numbers", &source, 0..4).unwrap();
        let waited = ReadBack::buffer(&device, &mut encoder, "numbers", &source, 0..4).unwrap();
        std::thread::scope(|scope| {
            let awaiting = scope.spawn(|| block_on(awaited));
            std::thread::sleep(Duration::from_millis(20));
            if finished {
                drop(encoder.finish())
            } else {
                drop(encoder)
            }
            let error = awaiting.join().unwrap().unwrap_err();
            assert!(error.to_string().contains("`numbers` cannot be read back: the encoder"), "{error}");
        });
        assert!(waited.is_ready());
        assert!(waited.wait(&device).unwrap_err().to_string().contains("dropped"));
    }
}

#[test]
fn waiting_for_an_encoder_that_is_never_submitted_is_an_error() {
    let (device, queue) = noop();
    let mut encoder = encoder(&device);
    let source = buffer(&device, &[0; 4]);
    let back = ReadBack::buffer(&device, &mut encoder, "numbers", &source, 0..4).unwrap();
    let start = Instant::now();
    assert!(back.wait(&device).unwrap_err().to_string().contains("submit it before waiting"));
    assert!(start.elapsed() < Duration::from_secs(30));
    // No receiver is left, which is fine.
    valid(&device, || queue.submit([encoder.finish()]));
    valid(&device, || queue.submit([]));
}

#[test]
fn textures_that_cannot_be_copied_are_errors() {
    let (device, _queue) = noop();
    let plain = description([4, 4, 2], TextureFormat::Rgba8Unorm);
    let many = wgpu::TextureDescriptor {
        sample_count: 4,
        usage: TextureUsages::RENDER_ATTACHMENT | TextureUsages::COPY_SRC,
        ..description([4, 4, 1], TextureFormat::Rgba8Unorm)
    };
    assert!(
        problem_of(&device, &many, &FULL).contains("4 samples per texel: resolve it into a texture with one")
    );
    let sampled = wgpu::TextureDescriptor { usage: TextureUsages::TEXTURE_BINDING, ..plain.clone() };
    assert!(problem_of(&device, &sampled, &FULL).contains("created without COPY_SRC"));
    let mip = problem_of(&device, &plain, &TexturePart { mip: 1, ..FULL });
    assert!(mip.contains("it has 1 mip levels, but level 1 is requested"), "{mip}");
    let layers = problem_of(&device, &plain, &TexturePart { layers: 1..3, ..FULL });
    assert!(layers.contains("it has 2 layers, but 1..3 are requested"), "{layers}");
    let stencil = TexturePart { aspect: TextureAspect::StencilOnly, ..FULL };
    assert!(problem_of(&device, &plain, &stencil).contains("Rgba8Unorm has no aspect StencilOnly"));
}

#[test]
fn depth_that_cannot_be_copied_is_an_error() {
    let (device, _queue) = noop();
    let depth = TexturePart { aspect: TextureAspect::DepthOnly, ..FULL };
    let opaque = [
        (TextureFormat::Depth24Plus, &FULL),
        (TextureFormat::Depth24Plus, &depth),
        (TextureFormat::Depth24PlusStencil8, &depth),
    ];
    for (format, part) in opaque {
        let refused = problem_of(&device, &description([4, 4, 1], format), part);
        assert!(refused.contains("use Depth32Float instead"), "{refused}");
    }
    let both = problem_of(&device, &description([4, 4, 1], TextureFormat::Depth24PlusStencil8), &FULL);
    assert!(both.contains("two aspects"), "{both}");
}

#[test]
fn the_future_can_be_sent_to_another_thread() {
    fn sendable<T: Send + Sync + Unpin>() {}
    sendable::<ReadBack>();
}
