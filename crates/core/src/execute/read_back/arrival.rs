//! Whether the bytes have arrived: between wgpu's callback and whoever waits.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::task::Waker;
use std::time::Duration;

/// How a mapping ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// The buffer is mapped.
    Mapped,
    /// wgpu could not map it.
    Failed,
    /// The encoder was dropped, and the request to map with it.
    NeverSubmitted,
}

/// What the waiting side looks at.
#[derive(Default)]
pub(super) struct Arrival {
    state: Mutex<State>,
    settled: Condvar,
}

#[derive(Default)]
struct State {
    outcome: Option<Outcome>,
    waker: Option<Waker>,
}

/// The callback's end. Dropped without a call, it says that the call can no longer come.
pub(super) struct Messenger(Arc<Arrival>);

impl Arrival {
    /// Returns both ends.
    pub(super) fn new() -> (Arc<Self>, Messenger) {
        let arrival = Arc::new(Self::default());
        (arrival.clone(), Messenger(arrival))
    }

    pub(super) fn outcome(&self) -> Option<Outcome> {
        self.lock().outcome
    }

    /// Returns the outcome, or has `waker` woken when there is one; it replaces the waker of the last call.
    pub(super) fn outcome_or_wake(&self, waker: &Waker) -> Option<Outcome> {
        let mut state = self.lock();
        if state.outcome.is_none() {
            // Under the lock, so that the outcome cannot come between the look and this.
            match &mut state.waker {
                Some(stored) => stored.clone_from(waker),
                none => *none = Some(waker.clone()),
            }
        }
        state.outcome
    }

    /// Blocks until there is an outcome, for `time` at most.
    pub(super) fn outcome_within(&self, time: Duration) -> Option<Outcome> {
        let unsettled = |state: &mut State| state.outcome.is_none();
        let waited = self.settled.wait_timeout_while(self.lock(), time, unsettled);
        waited.unwrap_or_else(PoisonError::into_inner).0.outcome
    }

    /// The first outcome stands.
    fn settle(&self, outcome: Outcome) {
        let mut state = self.lock();
        if state.outcome.is_some() {
            return;
        }
        state.outcome = Some(outcome);
        let waker = state.waker.take();
        drop(state);
        self.settled.notify_all();
        // Outside the lock: a waker may run anything, even the future itself.
        if let Some(waker) = waker {
            waker.wake();
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Messenger {
    pub(super) fn report(self, mapped: Result<(), wgpu::BufferAsyncError>) {
        self.0.settle(if mapped.is_ok() { Outcome::Mapped } else { Outcome::Failed });
    }
}

impl Drop for Messenger {
    fn drop(&mut self) {
        self.0.settle(Outcome::NeverSubmitted);
    }
}
