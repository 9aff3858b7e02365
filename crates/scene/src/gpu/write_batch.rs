//! Writes to a buffer that are sent to the queue together.

/// The maximum size of one write to the queue, bytes.
const MAX_BYTES: usize = 4 << 20;

/// Consecutive writes that have not been sent yet. Many small ones cost as much as a large one.
#[derive(Default)]
pub(super) struct WriteBatch {
    target: Option<(wgpu::Buffer, u64)>,
    bytes: Vec<u8>,
}

impl WriteBatch {
    /// Adds a write; sends the previous ones first if this one does not continue them.
    pub(super) fn write(&mut self, queue: &wgpu::Queue, buffer: &wgpu::Buffer, offset: u64, bytes: &[u8]) {
        let continues = self
            .target
            .as_ref()
            .is_some_and(|(target, start)| target == buffer && start + self.bytes.len() as u64 == offset);
        if !continues {
            self.flush(queue);
            self.target = Some((buffer.clone(), offset));
        }
        for piece in bytes.chunks(MAX_BYTES) {
            if self.bytes.len() + piece.len() > MAX_BYTES {
                self.send(queue);
            }
            self.bytes.extend_from_slice(piece);
        }
    }

    /// Sends what has not been sent yet.
    pub(super) fn flush(&mut self, queue: &wgpu::Queue) {
        self.send(queue);
        self.target = None;
    }

    fn send(&mut self, queue: &wgpu::Queue) {
        if let Some((buffer, offset)) = self.target.as_mut().filter(|_| !self.bytes.is_empty()) {
            queue.write_buffer(buffer, *offset, &self.bytes);
            *offset += self.bytes.len() as u64;
            self.bytes.clear();
        }
    }
}
