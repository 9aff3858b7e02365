//! How long passes took, as plain data.

mod trace;

pub use trace::trace_json;

use serde::Serialize;
use std::collections::VecDeque;

/// The time of one pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PassTime {
    /// The pass, with its nodes before its name.
    pub pass: String,
    /// The node it belongs to; empty for none.
    pub node: String,
    /// When its body began on the CPU, milliseconds after the first pass was recorded; 0 for a pass without one.
    pub cpu_begin_ms: f64,
    /// Milliseconds that the pass's body took on the CPU; 0 for a pass without one.
    pub cpu_ms: f64,
    /// When it began on the GPU, milliseconds after the first pass there; `None` where the device cannot tell.
    pub gpu_begin_ms: Option<f64>,
    /// Milliseconds on the GPU; `None` where the device cannot tell, see `Timer`.
    pub gpu_ms: Option<f64>,
    /// How many passes `gpu_ms` is the time of: 1, or more where passes were merged and the device cannot tell them
    /// apart. Each of them then shows the same time.
    pub shared_by: u32,
    /// Draw calls, where the body told of them by `Resources::report_draws`; `None` where it did not.
    pub draws: Option<u32>,
    /// Triangles that were drawn, before what is outside the view was cut off; `None` where the device cannot tell.
    pub triangles: Option<u64>,
}

impl PassTime {
    /// Returns the GPU time with what passes share dealt out evenly among them, so that the sum over a frame counts each
    /// time once; `None` where the device cannot tell.
    ///
    /// ```
    /// use shadowgraph_core::PassTime;
    /// let merged = PassTime { gpu_ms: Some(6.0), shared_by: 3, ..PassTime::default() };
    /// assert_eq!(merged.gpu_share_ms(), Some(2.0));
    /// ```
    pub fn gpu_share_ms(&self) -> Option<f64> {
        Some(self.gpu_ms? / f64::from(self.shared_by.max(1)))
    }
}

impl TimeSummary {
    /// Returns the median of the GPU time, dealt out as by [`PassTime::gpu_share_ms`].
    pub fn gpu_share_ms(&self) -> Option<f64> {
        Some(self.gpu_ms?.median / f64::from(self.shared_by.max(1)))
    }
}

/// The times of the last frames, pass by pass.
///
/// ```
/// use shadowgraph_core::{PassTime, TimeHistory};
/// let mut history = TimeHistory::new(60);
/// for gpu_ms in [1.0, 9.0, 2.0] {
///     let (pass, node) = ("draw".to_owned(), String::new());
///     let time = PassTime { pass, node, cpu_ms: 0.1, gpu_ms: Some(gpu_ms), shared_by: 1, ..Default::default() };
///     history.add(&[time]);
/// }
/// let draw = &history.summary()[0];
/// assert_eq!((draw.gpu_ms.unwrap().median, draw.gpu_ms.unwrap().high), (2.0, 9.0));
/// ```
#[derive(Clone, Debug)]
pub struct TimeHistory {
    frames: usize,
    /// The oldest first; of frames of the same passes.
    times: VecDeque<Vec<PassTime>>,
}

/// What a pass took in the last frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeSummary {
    /// The pass, with its nodes before its name.
    pub pass: String,
    /// The node it belongs to; empty for none.
    pub node: String,
    /// Milliseconds on the CPU.
    pub cpu_ms: TimeStats,
    /// Milliseconds on the GPU; `None` where the device cannot tell.
    pub gpu_ms: Option<TimeStats>,
    /// As [`PassTime::shared_by`], in the last frame.
    pub shared_by: u32,
}

/// How times spread.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TimeStats {
    /// Half of the frames took less.
    pub median: f64,
    /// One frame in twenty took longer: the 95th percentile.
    pub high: f64,
}

impl TimeHistory {
    /// Keeps so many frames, at least 1.
    pub fn new(frames: usize) -> Self {
        Self { frames: frames.max(1), times: VecDeque::new() }
    }

    /// Adds a frame, as `Timer::read` gives it. A frame of other passes than the last begins anew.
    pub fn add(&mut self, times: &[PassTime]) {
        let same = |before: &Vec<PassTime>| {
            before.len() == times.len() && before.iter().zip(times).all(|(a, b)| a.pass == b.pass)
        };
        if !self.times.back().is_none_or(same) {
            self.times.clear();
        }
        self.times.push_back(times.to_vec());
        while self.times.len() > self.frames {
            self.times.pop_front();
        }
    }

    /// Returns how many frames it holds.
    pub fn frames(&self) -> usize {
        self.times.len()
    }

    /// Returns the passes in order of recording.
    pub fn summary(&self) -> Vec<TimeSummary> {
        let Some(last) = self.times.back() else { return Vec::new() };
        let of = |place: usize| self.times.iter().filter_map(move |frame| frame.get(place));
        let summary = |(place, time): (usize, &PassTime)| TimeSummary {
            pass: time.pass.clone(),
            node: time.node.clone(),
            cpu_ms: TimeStats::of(of(place).map(|time| time.cpu_ms).collect())
                .unwrap_or(TimeStats { median: time.cpu_ms, high: time.cpu_ms }),
            gpu_ms: TimeStats::of(of(place).filter_map(|time| time.gpu_ms).collect()),
            shared_by: time.shared_by,
        };
        last.iter().enumerate().map(summary).collect()
    }
}

impl TimeStats {
    /// By the nearest rank; `None` of no times.
    fn of(mut times: Vec<f64>) -> Option<Self> {
        times.sort_by(f64::total_cmp);
        let rank = |part: f64| ((times.len() as f64 * part).ceil() as usize).saturating_sub(1);
        Some(Self { median: *times.get(rank(0.5))?, high: *times.get(rank(0.95))? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(pass: &str, cpu_ms: f64) -> Vec<PassTime> {
        vec![PassTime { pass: pass.into(), cpu_ms, shared_by: 1, ..PassTime::default() }]
    }

    #[test]
    fn the_median_and_the_95th_percentile_are_those_of_the_last_frames() {
        let mut history = TimeHistory::new(100);
        (0..300).for_each(|number| history.add(&frame("draw", f64::from(number))));
        let draw = &history.summary()[0];
        assert_eq!((history.frames(), draw.cpu_ms), (100, TimeStats { median: 249.0, high: 294.0 }));
        assert_eq!(draw.gpu_ms, None);
    }

    #[test]
    fn frames_of_other_passes_begin_anew() {
        let mut history = TimeHistory::new(8);
        history.add(&frame("draw", 5.0));
        history.add(&frame("blur", 1.0));
        assert_eq!((history.frames(), &*history.summary()[0].pass), (1, "blur"));
        assert!(TimeHistory::new(0).summary().is_empty());
    }
}
