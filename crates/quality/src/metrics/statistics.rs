//! Means, percentiles and percentages that are never NaN.

use serde::{Deserialize, Serialize};

/// Count, mean and 99th percentile of values; all 0 if there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Number of values.
    pub count: usize,
    /// Mean, in the unit of the values.
    pub mean: f64,
    /// 99th [`percentile`], in the unit of the values.
    pub p99: f64,
}

impl Summary {
    /// Computes the summary of finite values.
    #[must_use]
    pub fn new(values: &[f32]) -> Self {
        let p99 = percentile(values, 99.0).map_or(0.0, f64::from);
        Self { count: values.len(), mean: mean(values.iter().copied()), p99 }
    }
}

/// Returns the value that `percent` (0 to 100) of the values do not exceed, by nearest rank: of n values in
/// sorted order, the one at index ⌈percent / 100 · n⌉, counted from 1, and the smallest for 0. So it is always one
/// of the values. `None` if there are none.
#[must_use]
pub fn percentile(values: &[f32], percent: f64) -> Option<f32> {
    let last = values.len().checked_sub(1)?;
    let rank = (percent * values.len() as f64 / 100.0).ceil();
    let mut values = values.to_vec();
    let (_, value, _) =
        values.select_nth_unstable_by((rank as usize).saturating_sub(1).min(last), f32::total_cmp);
    Some(*value)
}

/// Returns the mean, 0 if there are no values.
pub(super) fn mean(values: impl Iterator<Item = f32>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, n), value| (sum + f64::from(value), n + 1));
    sum / count.max(1) as f64
}

/// Returns `part` as a percentage of `whole`, 0 if `whole` is 0.
pub(super) fn percent(part: usize, whole: usize) -> f64 {
    100.0 * part as f64 / whole.max(1) as f64
}
