//! The numbers of instances that culled views draw, read back.

use shadowgraph_core::{Executed, Frame, ReadBack, ReadBackRequest, Subresource};
use shadowgraph_lighting::{CullCount, CullCounts};

use crate::error::Error;
use crate::rendered::CulledView;

/// Requests of a frame that is not executed yet, with the names of the views.
pub(super) struct CountRequests(Vec<(Vec<String>, ReadBackRequest)>);

impl CountRequests {
    /// Requests the numbers that the passes of `frame` publish.
    pub(super) fn new(frame: &mut Frame<'_>) -> Self {
        let counts = CullCounts::published_in(frame).0.into_iter();
        Self(
            counts
                .map(|CullCount { views, buffer, bytes }| {
                    (views, frame.read_back_buffer(&buffer, Subresource::FULL.bytes(bytes)))
                })
                .collect(),
        )
    }

    /// Takes the results of the frame, which arrive once it is submitted.
    pub(super) fn take(self, executed: &mut Executed) -> PendingCounts {
        let taken = self.0.into_iter().map(|(views, request)| (views, executed.read_back(request)));
        PendingCounts(taken.collect())
    }
}

/// The numbers of instances that the culled views of a recorded frame draw; they arrive once it is submitted.
pub struct PendingCounts(Vec<(Vec<String>, Option<ReadBack>)>);

impl PendingCounts {
    /// Waits for the submitted frame, and returns the numbers; none if the CPU culled.
    ///
    /// # Errors
    /// As [`ReadBack::wait`].
    pub fn wait(self, device: &wgpu::Device) -> Result<Vec<CulledView>, Error> {
        let mut culled = Vec::new();
        for (views, bytes) in self.0 {
            let bytes = bytes.ok_or_else(read_back_error)?.wait(device)?;
            let numbers = bytes.as_chunks().0.iter().map(|&number| u32::from_le_bytes(number));
            culled.extend(
                views.into_iter().zip(numbers).map(|(view, instances)| CulledView { view, instances }),
            );
        }
        Ok(culled)
    }
}

/// Returns the error for a read-back that the frame did not execute.
pub(super) fn read_back_error() -> Error {
    Error::Gpu("nothing was read back".into())
}
