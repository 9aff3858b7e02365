//! Errors of visibility: at the pixels of a view, between cascades, and from frame to frame.

use serde::{Deserialize, Serialize};

use super::band::Band;
use super::samples::{MetricsError, RECEIVER_N_DOT_L, Samples, check_fractions, check_length};

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

/// Maximum distance of near blockers, metres.
pub const NEAR_BLOCKER_M: f32 = 0.25;

/// Receivers that should be dark because of a near blocker, and how many of them are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MissingContacts {
    /// Number of contacts: receivers that should be dark, with a blocker nearer than [`NEAR_BLOCKER_M`].
    pub contacts: usize,
    /// Number of contacts that are lit: visibility above 1/2.
    #[serde(rename = "lost")]
    pub missing: usize,
    /// `missing` in percent of `contacts`; 0 if there are none.
    #[serde(rename = "lost_percent")]
    pub missing_percent: f64,
}

/// Counts missing contacts, inside and outside the band, because contacts are at edges.
#[must_use]
pub fn missing_contacts(samples: &Samples<'_>) -> MissingContacts {
    let near = |pixel: &usize| samples.images.blocker_distances_m[*pixel] < NEAR_BLOCKER_M;
    let contacts = samples.receivers().filter(|&pixel| samples.should_be_dark(pixel)).filter(near);
    let (contacts, missing) = contacts.fold((0, 0), |(contacts, missing), pixel| {
        (contacts + 1, missing + usize::from(samples.is_misclassified(pixel)))
    });
    MissingContacts { contacts, missing, missing_percent: percent(missing, contacts) }
}

/// Summarises the |difference of visibility| (0 to 1) of two cascades evaluated at the same points.
///
/// # Errors
/// - [`MetricsError::Length`]: the lists have different lengths.
/// - [`MetricsError::Value`]: a number is not from 0 to 1.
pub fn seam(nearer: &[f32], farther: &[f32]) -> Result<Summary, MetricsError> {
    check_length("farther", farther.len(), nearer.len())?;
    check_fractions("nearer", nearer)?;
    check_fractions("farther", farther)?;
    let differences: Vec<f32> = nearer.iter().zip(farther).map(|(a, b)| (a - b).abs()).collect();
    Ok(Summary::new(&differences))
}

/// Summarises |change of visibility| (0 to 1) from each frame to the next at a list of world points.
///
/// `frames` has the visibilities of the points frame by frame, `truths` their hard truths. A point whose
/// truth (at 1/2) differs between two frames does not count for that pair. The summary's count is that of
/// points times pairs that count.
///
/// # Errors
/// - [`MetricsError::Length`]: the numbers of frames and truths differ, or frames have different numbers of points.
/// - [`MetricsError::Value`]: a number is not from 0 to 1.
pub fn flicker(frames: &[Vec<f32>], truths: &[Vec<f32>]) -> Result<Summary, MetricsError> {
    check_length("truths", truths.len(), frames.len())?;
    let points = frames.first().map_or(0, Vec::len);
    for (list, frame) in frames.iter().map(|f| ("frames", f)).chain(truths.iter().map(|t| ("truths", t))) {
        check_length(list, frame.len(), points)?;
        check_fractions(list, frame)?;
    }
    let mut changes = Vec::with_capacity(points * frames.len().saturating_sub(1));
    for (frame, truth) in frames.windows(2).zip(truths.windows(2)) {
        let stays = |point: &usize| (truth[0][*point] < 0.5) == (truth[1][*point] < 0.5);
        changes.extend((0..points).filter(stays).map(|point| (frame[1][point] - frame[0][point]).abs()));
    }
    Ok(Summary::new(&changes))
}

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
