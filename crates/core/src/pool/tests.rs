//! Uploads through recycled chunks: on wgpu's noop device, which does copy buffers, and on one that draws.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::staging::{Chunk, Staging, aligned_range};
use super::uniforms::UniformBuffer;
use crate::Error;
use crate::read_back::ReadBack;
use crate::test_device::{block_on, drawing, noop, valid};

const KIB: u64 = 1024;

fn encoder(device: &wgpu::Device) -> wgpu::CommandEncoder {
    device.create_command_encoder(&Default::default())
}

fn target(device: &wgpu::Device, size: u64) -> wgpu::Buffer {
    let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::STORAGE;
    device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
}

/// Records a frame that uploads `bytes` and reads them back from a buffer on the GPU.
fn record(device: &wgpu::Device, staging: &mut Staging, bytes: &[u8]) -> (wgpu::CommandEncoder, ReadBack) {
    let mut encoder = encoder(device);
    let size = aligned_range(0, bytes.len() as u64, 4).end;
    let mut chunk = staging.begin(device, size).unwrap();
    let offset = chunk.write(bytes, 4);
    let target = target(device, size);
    encoder.copy_buffer_to_buffer(chunk.buffer(), offset, &target, 0, size);
    let back = ReadBack::buffer(device, &mut encoder, "target", &target, 0..size).unwrap();
    chunk.finish(&encoder);
    (encoder, back)
}

/// Uploads once and returns the chunk's buffer.
fn upload(device: &wgpu::Device, queue: &wgpu::Queue, staging: &mut Staging, bytes: u64) -> wgpu::Buffer {
    let encoder = encoder(device);
    let buffer = staging.begin(device, bytes).unwrap().finish(&encoder);
    queue.submit([encoder.finish()]);
    buffer
}

fn poll(device: &wgpu::Device) {
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
}

#[test]
fn blocks_are_written_at_their_offsets_and_padded_with_zeros_to_a_multiple_of_four() {
    let (device, queue) = noop();
    let mut staging = Staging::default();
    // Leaves bytes in the chunk that must not be visible later.
    let (dirty, back) = record(&device, &mut staging, &[0xff; 300]);
    queue.submit([dirty.finish()]);
    back.wait(&device).unwrap();
    let mut encoder = encoder(&device);
    let mut chunk = staging.begin(&device, 260).unwrap();
    let offsets = [chunk.write(&[1, 2, 3, 4, 5], 4), chunk.write(&[6], 4), chunk.write(&[7, 8], 256)];
    assert_eq!(offsets, [0, 8, 256]);
    let target = target(&device, 260);
    encoder.copy_buffer_to_buffer(chunk.buffer(), 0, &target, 0, 260);
    let back = ReadBack::buffer(&device, &mut encoder, "target", &target, 0..260).unwrap();
    chunk.finish(&encoder);
    valid(&device, || queue.submit([encoder.finish()]));
    let bytes = back.wait(&device).unwrap();
    assert_eq!(bytes[..13], [1, 2, 3, 4, 5, 0, 0, 0, 6, 0, 0, 0, 0xff]);
    assert_eq!(bytes[256..], [7, 8, 0, 0]);
}

#[test]
fn one_chunk_is_enough_where_the_device_is_polled_and_two_where_it_is_not() {
    for (polled, expected) in [(true, 1), (false, 2)] {
        let (device, queue) = noop();
        let mut staging = Staging::default();
        let mut buffers = Vec::new();
        for _ in 0..50 {
            let buffer = valid(&device, || upload(&device, &queue, &mut staging, 100 * KIB));
            if !buffers.contains(&buffer) {
                buffers.push(buffer);
            }
            staging.end_frame(8);
            if polled {
                poll(&device);
            }
        }
        assert_eq!(buffers.len(), expected, "polled: {polled}");
    }
}

#[test]
fn frames_recorded_before_any_is_submitted_keep_their_own_bytes() {
    for (device, queue) in [Some(noop()), drawing()].into_iter().flatten() {
        let mut staging = Staging::default();
        for round in 0..3 {
            let frames: Vec<_> = (0..5_u8)
                .map(|frame| record(&device, &mut staging, &vec![round * 5 + frame; 1000]))
                .collect();
            let (encoders, backs): (Vec<_>, Vec<_>) = frames.into_iter().unzip();
            // In the other order, one submission each.
            for encoder in encoders.into_iter().rev() {
                valid(&device, || queue.submit([encoder.finish()]));
            }
            for (frame, back) in (0..).zip(backs) {
                assert_eq!(back.wait(&device).unwrap(), vec![round * 5 + frame; 1000]);
            }
        }
        assert_eq!(staging.free_chunks(), 5, "the other rounds reused the five chunks of the first");
    }
}

#[test]
fn no_chunk_is_written_while_the_gpu_may_read_it() {
    let Some((device, queue)) = drawing() else { return };
    let mut staging = Staging::default();
    let size = 4 * 1024 * KIB as usize;
    let backs: Vec<_> = (0..20_u8)
        .map(|frame| {
            let (encoder, back) = record(&device, &mut staging, &vec![frame; size]);
            valid(&device, || queue.submit([encoder.finish()]));
            back
        })
        .collect();
    for (frame, back) in (0..).zip(backs) {
        assert!(back.wait(&device).unwrap().iter().all(|&byte| byte == frame), "frame {frame}");
    }
}

#[test]
fn a_dropped_encoder_drops_its_chunk() {
    let (device, queue) = noop();
    let mut staging = Staging::default();
    let (unfinished, _) = record(&device, &mut staging, &[1; 8]);
    let (finished, _) = record(&device, &mut staging, &[2; 8]);
    let finished = finished.finish();
    assert_eq!(staging.free_list_references(), 3);
    drop((unfinished, finished));
    assert_eq!(
        staging.free_list_references(),
        1,
        "no other reference to the list, so no callback and no chunk is left"
    );
    upload(&device, &queue, &mut staging, 8);
    poll(&device);
    assert_eq!(staging.free_chunks(), 1);
}

#[test]
fn a_chunk_of_a_rejected_submission_is_free_again() {
    let (device, queue) = noop();
    let mut staging = Staging::default();
    let (mut encoder, refused) = record(&device, &mut staging, &[1; 8]);
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    encoder.copy_buffer_to_buffer(&target(&device, 4), 0, &target(&device, 4), 0, 8);
    queue.submit([encoder.finish()]);
    assert!(block_on(scope.pop()).is_some());
    poll(&device);
    assert_eq!(staging.free_chunks(), 1);
    assert_eq!(refused.wait(&device).unwrap(), [0; 8]);
    let (encoder, back) = record(&device, &mut staging, &[3; 8]);
    valid(&device, || queue.submit([encoder.finish()]));
    assert_eq!(back.wait(&device).unwrap(), [3; 8]);
}

#[test]
fn a_destroyed_device_is_an_error_and_no_panic() {
    for (device, queue) in [Some(noop()), drawing()].into_iter().flatten() {
        let mut staging = Staging::default();
        let (encoder, back) = record(&device, &mut staging, &[1; 8]);
        let begun = staging.begin(&device, 8).unwrap();
        let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
        device.destroy();
        queue.submit([encoder.finish()]);
        let after = device.create_command_encoder(&Default::default());
        begun.finish(&after);
        assert_eq!(staging.begin(&device, 8).err(), Some(Error::DeviceLost));
        drop((after, block_on(scope.pop())));
        assert!(back.wait(&device).is_err());
        assert_eq!(staging.free_chunks(), 0);
    }
}

#[test]
fn idle_chunks_are_dropped() {
    let (device, queue) = noop();
    let mut staging = Staging::default();
    let large = upload(&device, &queue, &mut staging, 1024 * KIB);
    poll(&device);
    for _ in 0..8 {
        assert_ne!(upload(&device, &queue, &mut staging, 1), large, "small frames take small chunks");
        poll(&device);
        staging.end_frame(8);
        assert_eq!(staging.free_chunks(), 2);
    }
    staging.end_frame(8);
    assert_eq!(staging.free_chunks(), 1);
}

#[test]
fn uploads_beyond_the_largest_buffer_are_an_error() {
    let (device, _queue) = noop();
    let largest = device.limits().max_buffer_size;
    let begun = valid(&device, || Staging::default().begin(&device, largest + 1).map(|_: Chunk| ()));
    assert!(matches!(begun, Err(Error::Limit { limit: "max_buffer_size", .. })), "{begun:?}");
    let grown = UniformBuffer::default().prepare(&device, largest + 1);
    assert!(matches!(grown, Err(Error::Limit { .. })), "{grown:?}");
}

#[test]
fn uniform_blocks_start_at_multiples_of_256() {
    let mut frame = crate::Frame::new();
    let starts = [16, 256, 5, 4].map(|bytes| frame.uniform(&vec![1; bytes]).start);
    assert_eq!(starts, [0, 256, 512, 768]);
    assert_eq!(frame.work.uniforms.len(), 772);
}

#[test]
fn the_uniform_buffer_stays_the_same_until_it_is_too_small() {
    let (device, _queue) = noop();
    let mut buffer = UniformBuffer::default();
    let first = buffer.prepare(&device, 100).unwrap();
    assert_eq!(buffer.prepare(&device, first.size()).unwrap(), first);
    let grown = buffer.prepare(&device, first.size() + 1).unwrap();
    assert_eq!(grown.size(), first.size() * 2);
    assert_eq!(buffer.prepare(&device, 1).unwrap(), grown);
}

/// A pipeline that copies a uniform block of 16 bytes into a buffer.
fn pipeline(device: &wgpu::Device) -> wgpu::ComputePipeline {
    let module = device.create_shader_module(wgpu::include_wgsl!("../../tests/uniform.wgsl"));
    device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: Default::default(),
        cache: None,
    })
}

/// Records a frame with two blocks, of which a pass reads the second.
fn uniform_frame(
    device: &wgpu::Device,
    (staging, buffer): (&mut Staging, &mut UniformBuffer),
    pipeline: &wgpu::ComputePipeline,
    values: [u32; 4],
) -> (wgpu::CommandEncoder, ReadBack) {
    let mut encoder = encoder(device);
    let values = values.map(u32::to_le_bytes).concat();
    let block = 256..256 + values.len() as u64;
    let mut uniforms = vec![0xff; 256];
    uniforms.extend(values);
    let mut chunk = staging.begin(device, aligned_range(0, block.end, 4).end).unwrap();
    let source = buffer.upload(device, &mut encoder, &mut chunk, &uniforms).unwrap();
    chunk.finish(&encoder);
    let seen = target(device, 16);
    let size = std::num::NonZeroU64::new(block.end - block.start);
    let binding = wgpu::BufferBinding { buffer: &source, offset: block.start, size };
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::Buffer(binding) },
            wgpu::BindGroupEntry { binding: 1, resource: seen.as_entire_binding() },
        ],
    });
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.dispatch_workgroups(1, 1, 1);
    drop(pass);
    let back = ReadBack::buffer(device, &mut encoder, "seen", &seen, 0..16).unwrap();
    (encoder, back)
}

#[test]
fn two_frames_recorded_before_either_is_submitted_read_their_own_uniforms() {
    let Some((device, queue)) = drawing() else { return };
    let pipeline = pipeline(&device);
    let (mut staging, mut buffer) = (Staging::default(), UniformBuffer::default());
    for order in [[0, 1], [1, 0]] {
        for at_once in [false, true] {
            let values = [[1, 2, 3, 4], [5, 6, 7, 8]];
            let frames =
                values.map(|values| uniform_frame(&device, (&mut staging, &mut buffer), &pipeline, values));
            let (encoders, backs): (Vec<_>, Vec<_>) = frames.into_iter().unzip();
            let mut commands: Vec<_> = encoders.into_iter().map(|encoder| Some(encoder.finish())).collect();
            let commands = order.map(|frame| commands[frame].take().unwrap());
            valid(&device, || {
                if at_once {
                    queue.submit(commands);
                } else {
                    for commands in commands {
                        queue.submit([commands]);
                    }
                }
            });
            for (values, back) in values.into_iter().zip(backs) {
                assert_eq!(back.wait(&device).unwrap(), values.map(u32::to_le_bytes).concat());
            }
        }
    }
}
