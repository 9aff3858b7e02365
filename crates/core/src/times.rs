//! Times of passes, as plain data.

use serde::Serialize;
use std::collections::VecDeque;

/// The time of one pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PassTime {
    /// The path of the pass: its nodes, then its name.
    pub pass: String,
    /// The path of its node; empty for none.
    pub node: String,
    /// Start of its body on the CPU, in milliseconds after recording began; 0 for a pass without a body.
    pub cpu_begin_ms: f64,
    /// Duration of its body on the CPU in milliseconds; 0 for a pass without a body.
    pub cpu_ms: f64,
    /// Start on the GPU, in milliseconds after the first pass; `None` if the device cannot measure it.
    pub gpu_begin_ms: Option<f64>,
    /// Duration on the GPU in milliseconds; `None` if the device cannot measure it, see `Timer`.
    pub gpu_ms: Option<f64>,
    /// Number of passes that `gpu_ms` measures: 1, or more where passes were merged and the device cannot measure them
    /// separately. Each of them then has the same time.
    pub shared_by: u32,
    /// Draw calls that the body reported by `Resources::report_draws`; `None` if it reported none.
    pub draws: Option<u32>,
    /// Triangles drawn, before clipping; `None` if the device cannot count them.
    pub triangles: Option<u64>,
}

impl PassTime {
    /// Returns the GPU time, divided evenly among passes that share it, so that the sum over a frame counts each time once;
    /// `None` if the device cannot measure it.
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
    /// Returns the median of the GPU time, divided as by [`PassTime::gpu_share_ms`].
    pub fn gpu_share_ms(&self) -> Option<f64> {
        Some(self.gpu_ms?.median / f64::from(self.shared_by.max(1)))
    }
}

/// The times of each pass in the last frames.
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
    /// Times of frames with the same passes, the oldest first.
    times: VecDeque<Vec<PassTime>>,
}

/// Statistics of a pass over the last frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeSummary {
    /// The path of the pass: its nodes, then its name.
    pub pass: String,
    /// The path of its node; empty for none.
    pub node: String,
    /// Duration on the CPU in milliseconds.
    pub cpu_ms: TimeStats,
    /// Duration on the GPU in milliseconds; `None` if the device cannot measure it.
    pub gpu_ms: Option<TimeStats>,
    /// [`PassTime::shared_by`] of the last frame.
    pub shared_by: u32,
}

/// Statistics of times.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TimeStats {
    /// The median.
    pub median: f64,
    /// The 95th percentile.
    pub high: f64,
}

impl TimeHistory {
    /// Creates a history that keeps this many frames, at least 1.
    pub fn new(frames: usize) -> Self {
        Self { frames: frames.max(1), times: VecDeque::new() }
    }

    /// Adds a frame, as returned by `Timer::read`. A frame with different passes than the last one clears the history.
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

    /// Returns the number of frames that it holds.
    pub fn frames(&self) -> usize {
        self.times.len()
    }

    /// Returns the statistics of the passes in order of recording.
    pub fn summary(&self) -> Vec<TimeSummary> {
        let Some(last) = self.times.back() else { return Vec::new() };
        let times = |index: usize| self.times.iter().filter_map(move |frame| frame.get(index));
        let summary = |(index, time): (usize, &PassTime)| TimeSummary {
            pass: time.pass.clone(),
            node: time.node.clone(),
            cpu_ms: TimeStats::from_times(times(index).map(|time| time.cpu_ms).collect())
                .unwrap_or(TimeStats { median: time.cpu_ms, high: time.cpu_ms }),
            gpu_ms: TimeStats::from_times(times(index).filter_map(|time| time.gpu_ms).collect()),
            shared_by: time.shared_by,
        };
        last.iter().enumerate().map(summary).collect()
    }
}

impl TimeStats {
    /// Computes percentiles by the nearest rank; `None` without times.
    fn from_times(mut times: Vec<f64>) -> Option<Self> {
        times.sort_by(f64::total_cmp);
        let rank = |fraction: f64| ((times.len() as f64 * fraction).ceil() as usize).saturating_sub(1);
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
    fn a_frame_with_other_passes_clears_the_history() {
        let mut history = TimeHistory::new(8);
        history.add(&frame("draw", 5.0));
        history.add(&frame("blur", 1.0));
        assert_eq!((history.frames(), &*history.summary()[0].pass), (1, "blur"));
        assert!(TimeHistory::new(0).summary().is_empty());
    }
}
