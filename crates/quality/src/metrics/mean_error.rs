//! Mean error of visibility, faint acne included.

use serde::{Deserialize, Serialize};

use super::statistics::mean;
use super::{Band, Samples};

/// Mean of |visibility - truth| over receivers, with and without the band.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeanError {
    /// Mean over the receivers outside the band, percent; 0 if there are none.
    pub outside_percent: f64,
    /// Mean over all receivers, percent; 0 if there are none.
    pub total_percent: f64,
}

/// Measures the mean error against the hard reference.
#[must_use]
pub fn mean_error(samples: &Samples<'_>, band: &Band) -> MeanError {
    let outside = samples.receivers().filter(|&pixel| !band.contains(pixel));
    MeanError {
        outside_percent: 100.0 * mean(outside.map(|pixel| samples.error(pixel))),
        total_percent: 100.0 * mean(samples.receivers().map(|pixel| samples.error(pixel))),
    }
}
