//! What the GPU counts in a frame, read back.

use shadowgraph_core::{Executed, Frame, ReadBack, ReadBackRequest, Subresource};
use shadowgraph_lighting::{CullCount, CullCounts};
use shadowgraph_shadows::ShadowCounts;

use crate::error::Error;
use crate::rendered::{CulledView, FrameCounts};

/// Requests of a frame that is not executed yet.
pub(super) struct CountRequests {
    /// With the names of the views.
    culled: Vec<(Vec<String>, ReadBackRequest)>,
    shadows: Option<(ShadowCounts, ReadBackRequest)>,
}

impl CountRequests {
    /// Requests the numbers that the passes of `frame` publish.
    pub(super) fn new(frame: &mut Frame<'_>) -> Self {
        let counts = CullCounts::published_in(frame).0.into_iter();
        let culled = counts
            .map(|CullCount { views, buffer, bytes }| {
                (views, frame.read_back_buffer(&buffer, Subresource::FULL.bytes(bytes)))
            })
            .collect();
        let shadows = frame.published::<ShadowCounts>().ok().cloned();
        let shadows = shadows.map(|counts| {
            let part = Subresource::FULL.bytes(counts.bytes.clone());
            let request = frame.read_back_buffer(&counts.buffer, part);
            (counts, request)
        });
        Self { culled, shadows }
    }

    /// Takes the results of the frame, which arrive once it is submitted.
    pub(super) fn take(self, executed: &mut Executed) -> PendingCounts {
        let culled = self.culled.into_iter();
        PendingCounts {
            culled: culled.map(|(views, request)| (views, executed.read_back(request))).collect(),
            shadows: self.shadows.map(|(counts, request)| (counts, executed.read_back(request))),
        }
    }
}

/// What the GPU counts in a recorded frame; the numbers arrive once it is submitted.
pub struct PendingCounts {
    culled: Vec<(Vec<String>, Option<ReadBack>)>,
    shadows: Option<(ShadowCounts, Option<ReadBack>)>,
}

impl PendingCounts {
    /// Returns whether the numbers of the submitted frame have arrived, so that [`wait`](Self::wait) does not wait. In
    /// browsers, which cannot wait, ask this first.
    pub fn is_ready(&self) -> bool {
        let culled = self.culled.iter().map(|(_, bytes)| bytes);
        let mut all = culled.chain(self.shadows.iter().map(|(_, bytes)| bytes));
        all.all(|bytes| bytes.as_ref().is_none_or(ReadBack::is_ready))
    }

    /// Waits for the submitted frame, and returns the numbers.
    ///
    /// # Errors
    /// As [`ReadBack::wait`].
    pub fn wait(self, device: &wgpu::Device) -> Result<FrameCounts, Error> {
        let mut counts = FrameCounts::default();
        for (views, bytes) in self.culled {
            let numbers = numbers(bytes, device)?.into_iter();
            let views = views.into_iter().zip(numbers);
            counts.culled.extend(views.map(|(view, instances)| CulledView { view, instances }));
        }
        if let Some((ShadowCounts { names, warning, .. }, bytes)) = self.shadows {
            let numbers = numbers(bytes, device)?;
            counts.shadow_warning = warning(&numbers);
            counts.shadows = names.iter().copied().zip(numbers).collect();
        }
        Ok(counts)
    }
}

fn numbers(bytes: Option<ReadBack>, device: &wgpu::Device) -> Result<Vec<u32>, Error> {
    let bytes = bytes.ok_or_else(read_back_error)?.wait(device)?;
    Ok(bytes.as_chunks().0.iter().map(|&number| u32::from_le_bytes(number)).collect())
}

/// Returns the error for a read-back that the frame did not execute.
pub(crate) fn read_back_error() -> Error {
    Error::Gpu("nothing was read back".into())
}
