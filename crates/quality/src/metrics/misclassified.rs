//! Misclassified pixels.

use serde::{Deserialize, Serialize};

use super::statistics::percent;
use super::{Band, RECEIVER_N_DOT_L, Samples};

/// Lower ends of the bins of N·L; each ends where the next begins, the last at 1.
pub const N_DOT_L_BINS: [f32; 4] = [RECEIVER_N_DOT_L, 0.1, 0.25, 0.5];

/// Misclassified receivers, with and without the band.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Misclassified {
    /// Counts of the receivers outside the band.
    pub outside: MisclassifiedCounts,
    /// Counts of all receivers.
    pub total: MisclassifiedCounts,
}

/// Counts of misclassified receivers: |visibility - truth| is above 1/2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MisclassifiedCounts {
    /// Number of receivers.
    pub receivers: usize,
    /// Number of misclassified receivers.
    #[serde(rename = "wrong")]
    pub misclassified: usize,
    /// Number of receivers that are dark but should be lit.
    pub acne: usize,
    /// Number of receivers that are lit but should be dark.
    pub leak: usize,
    /// `misclassified` in percent of `receivers`; 0 if there are none.
    #[serde(rename = "wrong_percent")]
    pub misclassified_percent: f64,
    /// `acne` in percent of `receivers`; 0 if there are none.
    pub acne_percent: f64,
    /// `leak` in percent of `receivers`; 0 if there are none.
    pub leak_percent: f64,
    /// Acne in bins of N·L; each bin ends where the next begins.
    pub acne_by_n_dot_l: [AcneBin; N_DOT_L_BINS.len()],
}

/// Acne on surfaces in a range of N·L.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AcneBin {
    /// Exclusive lower end of N·L; the upper end is inclusive.
    pub n_dot_l_above: f32,
    /// Number of receivers.
    pub receivers: usize,
    /// Number of receivers that are dark but should be lit.
    pub acne: usize,
    /// `acne` in percent of `receivers`; 0 if there are none.
    pub acne_percent: f64,
}

/// Counts misclassified receivers, outside the band and in total.
#[must_use]
pub fn misclassified(samples: &Samples<'_>, band: &Band) -> Misclassified {
    Misclassified {
        outside: count(samples, samples.receivers().filter(|&pixel| !band.contains(pixel))),
        total: count(samples, samples.receivers()),
    }
}

fn count(samples: &Samples<'_>, receivers: impl Iterator<Item = usize>) -> MisclassifiedCounts {
    let mut counts = MisclassifiedCounts::default();
    for (bin, n_dot_l) in counts.acne_by_n_dot_l.iter_mut().zip(N_DOT_L_BINS) {
        bin.n_dot_l_above = n_dot_l;
    }
    for pixel in receivers {
        let misclassified = samples.is_misclassified(pixel);
        let acne = misclassified && !samples.should_be_dark(pixel);
        counts.receivers += 1;
        counts.misclassified += usize::from(misclassified);
        counts.acne += usize::from(acne);
        let n_dot_l = samples.images.n_dot_l[pixel];
        if let Some(bin) = counts.acne_by_n_dot_l.iter_mut().rfind(|bin| n_dot_l > bin.n_dot_l_above) {
            bin.receivers += 1;
            bin.acne += usize::from(acne);
        }
    }
    counts.leak = counts.misclassified - counts.acne;
    counts.misclassified_percent = percent(counts.misclassified, counts.receivers);
    counts.acne_percent = percent(counts.acne, counts.receivers);
    counts.leak_percent = percent(counts.leak, counts.receivers);
    for bin in &mut counts.acne_by_n_dot_l {
        bin.acne_percent = percent(bin.acne, bin.receivers);
    }
    counts
}
