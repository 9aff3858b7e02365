//! The last frames.

/// How many frames are judged at a time. Up to 4 slow ones among them change nothing.
pub(super) const WINDOW: usize = 9;

/// How many frames after a change of level are left out: they had been begun before it, or made its maps.
pub(super) const LATENCY: usize = 3;

/// The times of the last frames since a change, milliseconds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Window {
    times_ms: [f64; WINDOW],
    /// How many came since the change, those that are left out too.
    seen: usize,
}

impl Window {
    pub(super) fn new() -> Self {
        Self { times_ms: [0.0; WINDOW], seen: 0 }
    }

    pub(super) fn push(&mut self, time_ms: f64) {
        self.times_ms[self.seen % WINDOW] = time_ms;
        self.seen += 1;
    }

    /// `None` until there are enough.
    pub(super) fn median_ms(&self) -> Option<f64> {
        if self.seen < LATENCY + WINDOW {
            return None;
        }
        let mut sorted = self.times_ms;
        sorted.sort_unstable_by(f64::total_cmp);
        Some(sorted[WINDOW / 2])
    }
}
