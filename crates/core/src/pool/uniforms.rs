//! The buffer that holds a frame's uniform blocks.

use super::staging::Chunk;
use crate::device::create_checked;
use crate::error::Error;

/// The smallest buffer in bytes.
const MIN_BYTES: u64 = 16 * 1024;

/// The buffer that holds the blocks on the GPU, the same from frame to frame until it is too small.
///
/// One buffer is enough for any number of frames in flight. A frame's blocks are copied in at the start of the encoder that
/// also records every pass that reads them, and a queue runs encoders one after the other, in the order of their
/// submission: a copy waits for the reads recorded before it, and reads wait for the copy before them (wgpu inserts
/// the barriers, since it knows every use of the buffer). So no other frame can come between a frame's copy and its
/// reads, whatever the order of submission. Keeping the buffer keeps bind groups valid; one that was too small lives on
/// in the encoders and bind groups that use it.
#[derive(Default)]
pub(crate) struct UniformBuffer {
    buffer: Option<wgpu::Buffer>,
}

impl UniformBuffer {
    /// Returns the buffer, grown to hold `bytes`.
    ///
    /// # Errors
    /// When the device allows no buffer of that size.
    pub(crate) fn prepare(&mut self, device: &wgpu::Device, bytes: u64) -> Result<wgpu::Buffer, Error> {
        if let Some(buffer) = self.buffer.as_ref().filter(|buffer| buffer.size() >= bytes) {
            return Ok(buffer.clone());
        }
        let largest = device.limits().max_buffer_size;
        super::check_limit("uniform blocks", "max_buffer_size", bytes, largest)?;
        let class = bytes.checked_next_power_of_two().unwrap_or(u64::MAX).max(MIN_BYTES);
        use wgpu::BufferUsages as Usage;
        let desc = wgpu::BufferDescriptor {
            label: Some("uniform blocks"),
            size: class.min(largest),
            usage: Usage::UNIFORM | Usage::STORAGE | Usage::COPY_DST,
            mapped_at_creation: false,
        };
        let buffer =
            create_checked(device, "uniform blocks", desc.size, |device| device.create_buffer(&desc))?;
        self.buffer = Some(buffer.clone());
        Ok(buffer)
    }

    /// Writes the blocks into `chunk` and records the one copy from there; to be called before the frame's passes.
    ///
    /// # Errors
    /// As [`prepare`](Self::prepare).
    pub(crate) fn upload(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        chunk: &mut Chunk,
        blocks: &[u8],
    ) -> Result<wgpu::Buffer, Error> {
        let size = (blocks.len() as u64).next_multiple_of(wgpu::COPY_BUFFER_ALIGNMENT);
        let buffer = self.prepare(device, size)?;
        if size > 0 {
            let offset = chunk.write(blocks, wgpu::COPY_BUFFER_ALIGNMENT);
            encoder.copy_buffer_to_buffer(chunk.buffer(), offset, &buffer, 0, size);
        }
        Ok(buffer)
    }
}
