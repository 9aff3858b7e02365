//! Reading results back to the CPU.

mod completion;
pub(crate) mod source;

#[cfg(test)]
mod tests;

pub(crate) use source::TexturePart;

use crate::desc::TextureDesc;
use crate::device::{create_checked, device_is_lost};
use crate::error::Error;
use crate::pool::check_limit;
use completion::{Completion, MapOutcome};
use std::ops::Range;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

/// Number and length of the steps in which [`ReadBack::wait`] waits for another thread that is submitting or polling.
const WAIT_STEPS: (u32, Duration) = (100, Duration::from_millis(10));

/// Bytes of a texture or buffer on their way to the CPU: a future, or block with [`wait`](Self::wait).
///
/// The copy is part of the encoder that it was recorded into. After that encoder has been submitted, a later
/// `Queue::submit` or `Device::poll`, from any thread, notices that the copy is done and wakes the future. The future
/// itself does not poll the device: a program that awaits it but calls neither waits forever.
///
/// ```no_run
/// # use shadowgraph_core::{Error, ReadBack, wgpu};
/// # fn spawn(_: impl Future<Output = ()>) {}
/// # async fn show(bytes: Vec<u8>) {}
/// # fn frame(device: wgpu::Device, texels: ReadBack) -> Result<(), Error> {
/// spawn(async move {
///     if let Ok(bytes) = texels.await {
///         show(bytes).await;
///     }
/// });
/// // In each iteration of the program's loop, whether it draws or not:
/// let _done = device.poll(wgpu::PollType::Poll);
/// # Ok(())
/// # }
/// ```
///
/// Texels are packed tightly, row after row and layer after layer, without the padding of a copy; rows of blocks in
/// compressed formats.
///
/// # Errors
/// When the encoder is dropped without having been submitted, or the bytes cannot be mapped (a lost device). A
/// submission that wgpu rejects for an error elsewhere in it yields zeros; wgpu reports that error separately.
#[must_use = "the bytes are returned only by awaiting this, or by `wait`"]
pub struct ReadBack {
    name: String,
    buffer: wgpu::Buffer,
    rows: Rows,
    completion: Arc<Completion>,
}

/// The location of the requested bytes in the mapped buffer, in bytes.
#[derive(Clone, Copy)]
struct Rows {
    offset: usize,
    bytes: usize,
    stride: usize,
    count: usize,
}

impl ReadBack {
    /// Records the copy of a part of a texture. `name` is used in errors.
    ///
    /// # Errors
    /// When the texture, its format or its usage does not allow the copy, or the part is not within it.
    pub(crate) fn texture(
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        name: &str,
        texture: &wgpu::Texture,
        part: &TexturePart,
    ) -> Result<Self, Error> {
        if !texture.usage().contains(wgpu::TextureUsages::COPY_SRC) {
            return Err(Error::ReadBack { resource: name.to_owned(), problem: source::missing_copy_src() });
        }
        let copy = source::texture(name, &TextureDesc::from_texture(texture), part)?;
        let buffer = create_target(device, name, copy.bytes())?;
        copy.record(encoder, texture, &buffer);
        Ok(Self::new(encoder, name, buffer, copy.rows()))
    }

    /// Records the copy of a range of a buffer, in bytes. `name` is used in errors.
    ///
    /// # Errors
    /// When the buffer's usage does not allow the copy, or the range is empty or not within it.
    pub(crate) fn buffer(
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        name: &str,
        buffer: &wgpu::Buffer,
        range: Range<u64>,
    ) -> Result<Self, Error> {
        let copied = source::buffer(name, buffer, &range)?;
        let copied_bytes = copied.end - copied.start;
        let target = create_target(device, name, copied_bytes)?;
        encoder.copy_buffer_to_buffer(buffer, copied.start, &target, 0, copied_bytes);
        let bytes = (range.end - range.start) as usize;
        let rows = Rows { offset: (range.start - copied.start) as usize, bytes, stride: bytes, count: 1 };
        Ok(Self::new(encoder, name, target, rows))
    }

    fn new(encoder: &wgpu::CommandEncoder, name: &str, buffer: wgpu::Buffer, rows: Rows) -> Self {
        let (completion, sender) = Completion::new();
        encoder.map_buffer_on_submit(&buffer, wgpu::MapMode::Read, .., move |mapped| sender.send(mapped));
        Self { name: name.to_owned(), buffer, rows, completion }
    }

    /// Returns whether the result is available, so that awaiting and waiting return at once.
    pub fn is_ready(&self) -> bool {
        self.completion.outcome().is_some()
    }

    /// Blocks until the bytes have arrived, and returns them. Submit the encoder before, or from another thread.
    ///
    /// # Errors
    /// Those of the future; [`Error::DeviceLost`] if that is why the bytes do not arrive; and an error when nothing is
    /// submitted within a second after the GPU has run out of work.
    pub fn wait(self, device: &wgpu::Device) -> Result<Vec<u8>, Error> {
        let lost = |error| if device_is_lost(device) { Error::DeviceLost } else { error };
        // Browsers can do nothing but this.
        if let Some(outcome) = self.completion.outcome() {
            return self.bytes(outcome).map_err(lost);
        }
        let (steps, step) = WAIT_STEPS;
        for _ in 0..steps {
            let polled = device.poll(wgpu::PollType::wait_indefinitely());
            polled.map_err(|error| self.problem(format!("waiting for the device failed: {error}")))?;
            // No outcome means that nothing was submitted, or that another thread has taken the callback but not run it
            // yet, or has submitted but not requested the mapping yet. The last two take very little time.
            if let Some(outcome) = self.completion.outcome_within(step) {
                return self.bytes(outcome).map_err(lost);
            }
        }
        Err(self.problem("the encoder with its copy was not submitted: submit it before waiting".into()))
    }

    fn bytes(&self, outcome: MapOutcome) -> Result<Vec<u8>, Error> {
        match outcome {
            MapOutcome::Mapped => {}
            MapOutcome::Failed => {
                return Err(self.problem("its bytes cannot be mapped; the device may be lost".into()));
            }
            MapOutcome::NeverSubmitted => {
                let problem = "the encoder with its copy was dropped: finish and submit it";
                return Err(self.problem(problem.into()));
            }
        }
        let mapped =
            self.buffer.get_mapped_range(..).map_err(|error| self.problem(format!("not mapped: {error}")))?;
        Ok(self.rows.pack(&mapped))
    }

    fn problem(&self, problem: String) -> Error {
        Error::ReadBack { resource: self.name.clone(), problem }
    }
}

impl Future for ReadBack {
    type Output = Result<Vec<u8>, Error>;

    fn poll(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Self::Output> {
        match self.completion.outcome_or_wake(context.waker()) {
            Some(outcome) => Poll::Ready(self.bytes(outcome)),
            None => Poll::Pending,
        }
    }
}

impl Rows {
    fn pack(self, mapped: &[u8]) -> Vec<u8> {
        let mut packed = Vec::with_capacity(self.bytes * self.count);
        for row in mapped[self.offset..].chunks(self.stride).take(self.count) {
            packed.extend_from_slice(&row[..self.bytes]);
        }
        packed
    }
}

fn create_target(device: &wgpu::Device, name: &str, size: u64) -> Result<wgpu::Buffer, Error> {
    check_limit(name, "max_buffer_size", size, device.limits().max_buffer_size)?;
    let desc = wgpu::BufferDescriptor {
        label: Some(name),
        size,
        usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    };
    create_checked(device, name, size, |device| device.create_buffer(&desc))
}
