//! What is remembered of a level while a cheaper one is in use.

use super::window::WINDOW;

/// What a better level is taken to cost, times the cheaper one, until more is known.
const USUAL_RATIO: f64 = 2.0;

/// How long it stays down at first, frames.
const FIRST_WAIT: u64 = 8 * WINDOW as u64;

/// How long it stays down at most, frames. Going up is not taken back, but went well, if it held for as long.
const LONGEST_WAIT: u64 = 256 * WINDOW as u64;

/// The scene has changed if the same level takes this many times as long as before, or as much less.
const CHANGE: f64 = 2.0;

/// Tells whether two medians of one level are of a scene that changed in between.
pub(super) fn has_changed(before_ms: f64, now_ms: f64) -> bool {
    now_ms > before_ms * CHANGE || now_ms < before_ms / CHANGE
}

/// A level, compared with the next cheaper one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Step {
    /// How many times as long the better level took, at least 1.
    ratio: f64,
    /// What the cheaper level took when it last went up from there, unless the scene changed since: then all of the ratio is
    /// believed.
    tried_ms: Option<f64>,
    /// When it last went up, frames.
    raised: Option<u64>,
    /// How long it stays down, frames.
    wait: u64,
}

impl Step {
    pub(super) fn new() -> Self {
        Self { ratio: USUAL_RATIO, tried_ms: None, raised: None, wait: FIRST_WAIT }
    }

    /// Remembers what the two levels took, one right after the other.
    pub(super) fn measured(&mut self, better_ms: f64, cheaper_ms: f64) {
        // The load can have grown in between; the better level does not cost less for that.
        self.ratio = (better_ms / cheaper_ms).max(1.0);
        self.tried_ms = self.tried_ms.filter(|tried_ms| !has_changed(*tried_ms, cheaper_ms));
    }

    /// What the better level would take if the cheaper one takes `cheaper_ms`.
    pub(super) fn expected_ms(&self, cheaper_ms: f64) -> f64 {
        cheaper_ms * if self.tried_ms.is_some() { self.ratio } else { self.ratio.min(USUAL_RATIO) }
    }

    /// Whether it has stayed down for long enough, frames.
    pub(super) fn has_waited(&self, frames: u64) -> bool {
        frames >= self.wait
    }

    pub(super) fn go_up(&mut self, frame: u64, cheaper_ms: f64) {
        self.tried_ms = Some(cheaper_ms);
        self.raised = Some(frame);
    }

    pub(super) fn come_down(&mut self, frame: u64) {
        let taken_back = self.raised.is_some_and(|raised| frame - raised < LONGEST_WAIT);
        self.wait = if taken_back { (2 * self.wait).min(LONGEST_WAIT) } else { FIRST_WAIT };
    }

    /// What it knows may be wrong by now.
    pub(super) fn doubt(&mut self) {
        self.tried_ms = None;
    }
}
