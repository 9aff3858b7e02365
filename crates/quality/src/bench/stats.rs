//! How samples are spread.

/// Quantiles of samples; all 0 where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stats {
    /// One in twenty is less.
    pub p5: f64,
    /// One in four is less.
    pub p25: f64,
    /// One in two is less.
    pub median: f64,
    /// One in four is more.
    pub p75: f64,
    /// One in twenty is more.
    pub p95: f64,
}

impl Stats {
    /// Finds the quantiles, each one of the samples.
    ///
    /// ```
    /// let spread = shadowgraph_quality::bench::Stats::of((1..=101).map(f64::from));
    /// assert_eq!((spread.p5, spread.median, spread.p95), (6.0, 51.0, 96.0));
    /// ```
    pub fn of(samples: impl Iterator<Item = f64>) -> Self {
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
