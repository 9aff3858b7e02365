//! Mapped memory through which a frame's bytes reach the GPU.

use crate::device::create_checked;
use crate::error::Error;
use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The smallest chunk in bytes.
const MIN_BYTES: u64 = 64 * 1024;

/// Mapped buffers that frames write their uploads into; each returns to the free list when the submission that reads
/// it has completed.
///
/// No queue is needed here: the encoder carries the request to map the chunk again, wgpu acts on it when that
/// encoder is submitted, and calls back from a later `Queue::submit` or `Device::poll`. So any number of frames may
/// be recorded before any is submitted. An encoder that is dropped drops its request and the chunk.
#[derive(Default)]
pub(crate) struct Staging {
    free: FreeList,
}

/// Chunks that are mapped and that no GPU work reads; shared with the callbacks that return them.
type FreeList = Arc<Mutex<Vec<FreeChunk>>>;

struct FreeChunk {
    buffer: wgpu::Buffer,
    idle_frames: u32,
}

/// A mapped buffer that one frame fills.
pub(crate) struct Chunk {
    buffer: wgpu::Buffer,
    /// `None` where wgpu could not map the buffer; it has reported that already.
    view: Option<wgpu::BufferViewMut>,
    end: u64,
    free: FreeList,
}

/// Returns the range of `bytes` bytes that follow `end` at a multiple of `align`, a power of two. The end is a multiple
/// of 4, as copies require. The size of a chunk is added up with this.
pub(crate) fn aligned_range(end: u64, bytes: u64, align: u64) -> Range<u64> {
    let start = end.next_multiple_of(align.max(wgpu::COPY_BUFFER_ALIGNMENT));
    start..start + bytes.next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT)
}

impl Staging {
    /// Returns a mapped chunk of at least `bytes`: a free one of the same power of two, or else a new one.
    ///
    /// # Errors
    /// When the device allows no buffer of that size.
    pub(crate) fn begin(&mut self, device: &wgpu::Device, bytes: u64) -> Result<Chunk, Error> {
        let class = bytes.checked_next_power_of_two().unwrap_or(u64::MAX).max(MIN_BYTES);
        let buffer = match self.take(bytes..=class) {
            Some(buffer) => buffer,
            None => create(device, bytes, class)?,
        };
        let view = buffer.get_mapped_range_mut(..).ok();
        Ok(Chunk { buffer, view, end: 0, free: self.free.clone() })
    }

    /// Drops the chunks that have been free for more than `frames` calls of this function. Call it once per frame.
    pub(crate) fn end_frame(&mut self, frames: u32) {
        lock(&self.free).retain_mut(|free| {
            free.idle_frames += 1;
            free.idle_frames <= frames
        });
    }

    /// Returns the number of free chunks.
    #[cfg(test)]
    pub(super) fn free_chunks(&self) -> usize {
        lock(&self.free).len()
    }

    /// Returns the number of references to the free list: this one and those of pending callbacks.
    #[cfg(test)]
    pub(super) fn free_list_references(&self) -> usize {
        Arc::strong_count(&self.free)
    }

    /// Takes the chunk that was returned last, so that surplus chunks stay idle and are dropped.
    ///
    /// A chunk larger than the size class is not taken: small frames would keep it alive forever after one large frame.
    fn take(&self, sizes: std::ops::RangeInclusive<u64>) -> Option<wgpu::Buffer> {
        let mut free = lock(&self.free);
        let index = free.iter().rposition(|free| sizes.contains(&free.buffer.size()))?;
        Some(free.remove(index).buffer)
    }
}

impl Chunk {
    /// Writes bytes at the next [`aligned_range`], then zeros up to a multiple of 4, and returns the offset.
    pub(crate) fn write(&mut self, bytes: &[u8], align: u64) -> u64 {
        let range = aligned_range(self.end, bytes.len() as u64, align);
        debug_assert!(range.end <= self.buffer.size(), "the chunk is too small");
        if let Some(view) = self.view.as_mut().filter(|_| range.end <= self.buffer.size()) {
            let start = range.start as usize;
            let end = start + bytes.len();
            view.slice(start..end).copy_from_slice(bytes);
            view.slice(end..range.end as usize).fill(0);
        }
        self.end = range.end;
        range.start
    }

    /// Returns the buffer to copy from, in the encoder that the chunk is finished with.
    pub(crate) fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// Unmaps the chunk, so that `encoder` may be submitted, and returns it to the free list after that submission.
    ///
    /// Copies from it may be recorded before and after, in this encoder and in any that is submitted before it: wgpu
    /// maps it again when the submission of this encoder has completed.
    pub(crate) fn finish(self, encoder: &wgpu::CommandEncoder) -> wgpu::Buffer {
        let Self { buffer, view, free, .. } = self;
        if view.is_none() {
            return buffer;
        }
        // wgpu does not unmap a buffer that has a mapped view.
        drop(view);
        buffer.unmap();
        let returned = buffer.clone();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Write, .., move |mapped| {
            if mapped.is_ok() {
                lock(&free).push(FreeChunk { buffer: returned, idle_frames: 0 });
            }
        });
        buffer
    }
}

/// Locks the list. It is consistent whenever the lock is free, so a poisoned lock can be ignored.
fn lock(free: &FreeList) -> MutexGuard<'_, Vec<FreeChunk>> {
    free.lock().unwrap_or_else(PoisonError::into_inner)
}

fn create(device: &wgpu::Device, bytes: u64, class: u64) -> Result<wgpu::Buffer, Error> {
    // The size of a mapped buffer must be a multiple of 4; the limit need not be.
    let largest = device.limits().max_buffer_size & !(wgpu::COPY_BUFFER_ALIGNMENT - 1);
    super::check_limit("frame uploads", "max_buffer_size", bytes, largest)?;
    let desc = wgpu::BufferDescriptor {
        label: Some("frame uploads"),
        size: class.min(largest),
        usage: wgpu::BufferUsages::MAP_WRITE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: true,
    };
    create_checked(device, "frame uploads", desc.size, |device| device.create_buffer(&desc))
}
