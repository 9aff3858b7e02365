//! Quantiles of samples.

use serde::Serialize;

/// Quantiles of samples; all 0 if there are none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Stats {
    /// 5th percentile.
    pub p5: f64,
    /// First quartile.
    pub p25: f64,
    /// Median.
    pub median: f64,
    /// Third quartile.
    pub p75: f64,
    /// 95th percentile.
    pub p95: f64,
}

impl Stats {
    /// Computes the quantiles, each by nearest rank.
    ///
    /// ```
    /// let stats = shadowgraph_quality::bench::Stats::from_samples((1..=101).map(f64::from));
    /// assert_eq!((stats.p5, stats.median, stats.p95), (6.0, 51.0, 96.0));
    /// ```
    pub fn from_samples(samples: impl Iterator<Item = f64>) -> Self {
        let mut samples: Vec<f64> = samples.collect();
        samples.sort_by(f64::total_cmp);
        let quantile = |part: f64| {
            let index = (samples.len().saturating_sub(1) as f64 * part).round() as usize;
            samples.get(index).copied().unwrap_or_default()
        };
        Self {
            p5: quantile(0.05),
            p25: quantile(0.25),
            median: quantile(0.5),
            p75: quantile(0.75),
            p95: quantile(0.95),
        }
    }
}
