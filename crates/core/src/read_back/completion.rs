//! The completion of a mapping, shared by wgpu's callback and the code that waits.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::Waker;
use std::time::Duration;

/// Outcome of a mapping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MapOutcome {
    /// The buffer is mapped.
    Mapped,
    /// wgpu could not map it.
    Failed,
    /// The encoder was dropped, and the request to map with it.
    NeverSubmitted,
}

/// The receiving end.
#[derive(Default)]
pub(super) struct Completion {
    state: Mutex<State>,
    completed: Condvar,
}

#[derive(Default)]
struct State {
    outcome: Option<MapOutcome>,
    waker: Option<Waker>,
}

/// The callback's end. Dropping it without a call reports that the call can no longer come.
pub(super) struct CompletionSender(Arc<Completion>);

impl Completion {
    /// Returns both ends.
    pub(super) fn new() -> (Arc<Self>, CompletionSender) {
        let completion = Arc::new(Self::default());
        (completion.clone(), CompletionSender(completion))
    }

    pub(super) fn outcome(&self) -> Option<MapOutcome> {
        self.lock().outcome
    }

    /// Returns the outcome, or registers `waker` in place of that of the last call.
    pub(super) fn outcome_or_wake(&self, waker: &Waker) -> Option<MapOutcome> {
        let mut state = self.lock();
        if state.outcome.is_none() {
            // Under the lock, so that the outcome cannot be set between the check and this.
            match &mut state.waker {
                Some(stored) => stored.clone_from(waker),
                none => *none = Some(waker.clone()),
            }
        }
        state.outcome
    }

    /// Blocks until there is an outcome, for `time` at most.
    pub(super) fn outcome_within(&self, time: Duration) -> Option<MapOutcome> {
        let is_pending = |state: &mut State| state.outcome.is_none();
        let waited = self.completed.wait_timeout_while(self.lock(), time, is_pending);
        waited.unwrap_or_else(PoisonError::into_inner).0.outcome
    }

    /// Sets the outcome, unless there is one already.
    fn complete(&self, outcome: MapOutcome) {
        let mut state = self.lock();
        if state.outcome.is_some() {
            return;
        }
        state.outcome = Some(outcome);
        let waker = state.waker.take();
        drop(state);
        self.completed.notify_all();
        // Outside the lock: a waker may run any code, even the future itself.
        if let Some(waker) = waker {
            waker.wake();
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl CompletionSender {
    pub(super) fn send(self, mapped: Result<(), wgpu::BufferAsyncError>) {
        self.0.complete(if mapped.is_ok() { MapOutcome::Mapped } else { MapOutcome::Failed });
    }
}

impl Drop for CompletionSender {
    fn drop(&mut self) {
        self.0.complete(MapOutcome::NeverSubmitted);
    }
}
