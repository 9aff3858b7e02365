//! Results of one-line dispatches.

use super::{Gpu, kernel, texture, words};
use crate::{Contents, Format, Subresource};

fn bytes(numbers: impl IntoIterator<Item = u32>) -> Vec<u8> {
    numbers.into_iter().flat_map(u32::to_le_bytes).collect()
}

#[test]
fn numbers_are_doubled() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut numbers = frame.upload_buffer("numbers", bytes(0..10));
    frame
        .compute("double", &kernel("double"))
        .storage_mut(&mut numbers, Contents::Preserve)
        .dispatch([3, 1, 1]);
    let read = frame.read_back_buffer(&numbers, Subresource::FULL);
    let [doubled] = gpu.bytes(frame, [read]);
    assert_eq!(words(&doubled), (0..10).map(|n| 2 * n).collect::<Vec<_>>());
}

#[test]
fn a_range_of_a_buffer_is_bound() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let mut numbers = frame.upload_buffer("numbers", bytes(0..128));
    let part = Subresource::FULL.bytes(256..264);
    frame
        .compute("double", &kernel("double"))
        .subresource(part)
        .storage_mut(&mut numbers, Contents::Preserve)
        .dispatch([32, 1, 1]);
    let read = frame.read_back_buffer(&numbers, Subresource::FULL);
    let [doubled] = gpu.bytes(frame, [read]);
    let expected: Vec<u32> = (0..128).map(|n| if n == 64 || n == 65 { 2 * n } else { n }).collect();
    assert_eq!(words(&doubled), expected);
}

#[test]
fn frames_in_flight_compute_with_their_own_uniforms() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let multiply = kernel("multiply");
    let mut pending = Vec::new();
    for times in 1..=4u32 {
        let mut frame = gpu.graph.frame();
        let mut numbers = frame.upload_buffer("numbers", bytes(0..5));
        frame
            .compute("multiply", &multiply)
            .storage_mut(&mut numbers, Contents::Preserve)
            .uniform(&times.to_le_bytes())
            .dispatch([2, 1, 1]);
        let read = frame.read_back_buffer(&numbers, Subresource::FULL.bytes(4..20));
        let (mut executed, encoder) = gpu.record(frame).unwrap();
        pending.push((times, executed.read_back(read).unwrap(), encoder.finish()));
    }
    let mut reads = Vec::new();
    for (times, read, commands) in pending.into_iter().rev() {
        gpu.queue.submit([commands]);
        reads.push((times, read));
    }
    for (times, read) in reads {
        let expected: Vec<u32> = (1..5).map(|n| n * times).collect();
        assert_eq!(words(&read.wait(&gpu.device).unwrap()), expected);
    }
}

#[test]
fn the_number_of_workgroups_may_come_from_a_buffer() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let arguments = frame.upload_buffer("arguments", bytes([9, 9, 1, 1, 1]));
    let mut numbers = frame.upload_buffer("numbers", bytes(0..10));
    frame
        .compute("double", &kernel("double"))
        .storage_mut(&mut numbers, Contents::Preserve)
        .dispatch_indirect(&arguments, 8);
    let read = frame.read_back_buffer(&numbers, Subresource::FULL);
    let [doubled] = gpu.bytes(frame, [read]);
    assert_eq!(words(&doubled), [0, 2, 4, 6, 4, 5, 6, 7, 8, 9], "one workgroup of four");
}

#[test]
fn a_storage_texture_is_written_from_a_buffer() {
    let Some(mut gpu) = Gpu::drawing() else { return };
    let mut frame = gpu.graph.frame();
    let inputs = frame.upload_buffer("inputs", bytes([1, 2, 3]));
    let mut outputs = texture(&mut frame, "outputs", 3, Format::R32Uint);
    frame
        .compute("paint", &kernel("paint"))
        .storage(&inputs)
        .storage_texture_mut(&mut outputs, Contents::Overwrite)
        .dispatch([3, 3, 1]);
    let read = frame.read_back_texture(&outputs, Subresource::FULL);
    let [painted] = gpu.bytes(frame, [read]);
    assert_eq!(words(&painted), [10, 20, 30, 11, 21, 31, 12, 22, 32]);
}
