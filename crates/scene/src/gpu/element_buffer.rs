//! A buffer of elements that are allocated in ranges, and grows.

use std::ops::Range;

use range_alloc::RangeAllocator;

use super::limits;
use super::write_batch::WriteBatch;
use crate::error::Error;

/// A buffer that grows by copying its contents to a larger one.
pub(super) struct ElementBuffer {
    pub(super) buffer: wgpu::Buffer,
    label: &'static str,
    usage: wgpu::BufferUsages,
    element_bytes: u64,
    /// The largest number of elements that a draw can address.
    max_elements: u64,
    allocator: RangeAllocator<u64>,
    writes: WriteBatch,
}

impl ElementBuffer {
    /// Creates a buffer for `capacity` elements (at least one, since an empty buffer cannot be bound).
    pub(super) fn new(
        device: &wgpu::Device,
        (label, usage): (&'static str, wgpu::BufferUsages),
        (element_bytes, max_elements): (u64, u64),
        capacity: u64,
    ) -> Result<Self, Error> {
        let usage = usage | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let capacity = capacity.max(1);
        check(device, label, (element_bytes, max_elements), capacity)?;
        Ok(Self {
            buffer: create(device, label, usage, capacity * element_bytes),
            label,
            usage,
            element_bytes,
            max_elements,
            allocator: RangeAllocator::new(0..capacity),
            writes: WriteBatch::default(),
        })
    }

    /// Allocates a range of elements; an empty one for a count of 0.
    ///
    /// # Errors
    /// [`Error::Limit`] if the buffer would be larger than the device allows.
    pub(super) fn allocate(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        count: u64,
    ) -> Result<Range<u64>, Error> {
        if count == 0 {
            return Ok(0..0);
        }
        if let Ok(range) = self.allocator.allocate_range(count) {
            return Ok(range);
        }
        self.grow(device, queue, count)?;
        let capacity = self.allocator.initial_range().end;
        // The new end of the buffer has enough elements.
        Ok(self.allocator.allocate_range(count).unwrap_or(capacity - count..capacity))
    }

    /// Frees a range.
    pub(super) fn free(&mut self, range: Range<u64>) {
        if !range.is_empty() {
            self.allocator.free_range(range);
        }
    }

    /// Writes elements from `first` on, with the next [`flush`](Self::flush).
    pub(super) fn write(&mut self, queue: &wgpu::Queue, first: u64, bytes: &[u8]) {
        self.writes.write(queue, &self.buffer, first * self.element_bytes, bytes);
    }

    pub(super) fn flush(&mut self, queue: &wgpu::Queue) {
        self.writes.flush(queue);
    }

    /// Appends at least `count` elements; doubles the size if the device allows it.
    fn grow(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, count: u64) -> Result<(), Error> {
        let previous = self.allocator.initial_range().end;
        let element = (self.element_bytes, self.max_elements);
        check(device, self.label, element, previous + count)?;
        let most = (device.limits().max_buffer_size / self.element_bytes).min(self.max_elements);
        let capacity = (previous + count.max(previous)).min(most);
        self.writes.flush(queue);
        let larger = create(device, self.label, self.usage, capacity * self.element_bytes);
        let mut encoder =
            device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("grow") });
        encoder.copy_buffer_to_buffer(&self.buffer, 0, &larger, 0, previous * self.element_bytes);
        queue.submit([encoder.finish()]);
        self.buffer = larger;
        self.allocator.grow_to(capacity);
        Ok(())
    }
}

fn check(
    device: &wgpu::Device,
    label: &str,
    (element_bytes, max_elements): (u64, u64),
    elements: u64,
) -> Result<(), Error> {
    limits::addressable(label, elements, max_elements)?;
    limits::buffer(&device.limits(), &format!("the scene's {label}"), elements * element_bytes)
}

fn create(device: &wgpu::Device, label: &str, usage: wgpu::BufferUsages, size: u64) -> wgpu::Buffer {
    let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
    device.create_buffer(&descriptor)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    fn buffer(limits: wgpu::Limits, capacity: u64) -> (wgpu::Device, wgpu::Queue, ElementBuffer) {
        let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
        let (device, queue) = wgpu::Device::noop(&descriptor);
        let usage = wgpu::BufferUsages::INDEX;
        let created = ElementBuffer::new(&device, ("indices", usage), (4, 1 << 32), capacity).unwrap();
        (device, queue, created)
    }

    #[test]
    fn freed_ranges_are_reused_before_the_buffer_grows() {
        let (device, queue, mut buffer) = buffer(wgpu::Limits::default(), 30);
        let ranges: Vec<_> = (0..3).map(|_| buffer.allocate(&device, &queue, 10).unwrap()).collect();
        assert_eq!(ranges, [0..10, 10..20, 20..30]);
        buffer.free(10..20);
        assert_eq!(buffer.allocate(&device, &queue, 8).unwrap(), 10..18);
        assert_eq!(buffer.buffer.size(), 120);
        assert_eq!(buffer.allocate(&device, &queue, 0).unwrap(), 0..0);
        assert_eq!(buffer.allocate(&device, &queue, 3).unwrap(), 30..33);
        assert_eq!(buffer.buffer.size(), 240);
    }

    #[test]
    fn a_buffer_grows_up_to_the_limit_of_the_device_and_no_further() {
        let limits = wgpu::Limits { max_buffer_size: 200, ..wgpu::Limits::default() };
        let (device, queue, mut buffer) = buffer(limits, 30);
        assert_eq!(buffer.allocate(&device, &queue, 30).unwrap(), 0..30);
        assert_eq!(buffer.allocate(&device, &queue, 15).unwrap(), 30..45);
        assert_eq!(buffer.buffer.size(), 200);
        let error = buffer.allocate(&device, &queue, 20).unwrap_err().to_string();
        assert_eq!(error, "the scene's indices (bytes): 280 exceeds the adapter's max_buffer_size of 200");
    }
}
