//! How far visibility is off on average, faint acne included.

use serde::{Deserialize, Serialize};

use super::statistics::mean;
use super::{Band, Samples};

/// The mean of |visibility - truth| over receivers, with those in the band and without.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeanError {
    /// Over the receivers outside the band, percent (100 is every pixel wrong); 0 if there are none.
    pub outside_percent: f64,
    /// Over all receivers, percent; 0 if there are none.
    pub total_percent: f64,
}

/// Measures the mean error against hard truth.
#[must_use]
pub fn mean_error(samples: &Samples<'_>, band: &Band) -> MeanError {
    let outside = samples.receivers().filter(|&pixel| !band.contains(pixel));
    MeanError {
        outside_percent: 100.0 * mean(outside.map(|pixel| samples.error(pixel))),
        total_percent: 100.0 * mean(samples.receivers().map(|pixel| samples.error(pixel))),
    }
}
