//! How many pixels are on the wrong side of one half.

use serde::{Deserialize, Serialize};

use super::statistics::percent;
use super::{Band, RECEIVER_N_DOT_L, Samples};

/// Where the bins of N·L begin; each ends where the next one begins, the last one at 1.
pub const N_DOT_L_BINS: [f32; 4] = [RECEIVER_N_DOT_L, 0.1, 0.25, 0.5];

/// Wrong receivers, with those in the band and without.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Misclassified {
    /// Of the receivers outside the band.
    pub outside: Wrong,
    /// Of all receivers.
    pub total: Wrong,
}

/// Wrong receivers: |visibility - truth| is above 1/2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wrong {
    /// How many receivers there are.
    pub receivers: usize,
    /// How many are wrong, either way.
    pub wrong: usize,
    /// How many are dark but truly lit.
    pub acne: usize,
    /// How many are lit but truly dark.
    pub leak: usize,
    /// `wrong` in percent of `receivers`; 0 if there are none.
    #[serde(rename = "wrong_percent")]
    pub misclassified_percent: f64,
    /// `acne` in percent of `receivers`; 0 if there are none.
    pub acne_percent: f64,
    /// `leak` in percent of `receivers`; 0 if there are none.
    pub leak_percent: f64,
    /// The acne by how the surface is turned to the light: bins, each up to where the next one begins.
    pub acne_by_n_dot_l: [AcneBin; N_DOT_L_BINS.len()],
}

/// Acne on surfaces turned to the light at about the same angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AcneBin {
    /// Above this N·L, up to and with where the next bin begins.
    pub n_dot_l_above: f32,
    /// How many receivers there are.
    pub receivers: usize,
    /// How many are dark but truly lit.
    pub acne: usize,
    /// `acne` in percent of `receivers`; 0 if there are none.
    pub acne_percent: f64,
}

/// Counts wrong receivers, outside the band and in total.
#[must_use]
pub fn misclassified(samples: &Samples<'_>, band: &Band) -> Misclassified {
    Misclassified {
        outside: wrong(samples, samples.receivers().filter(|&pixel| !band.contains(pixel))),
        total: wrong(samples, samples.receivers()),
    }
}

fn wrong(samples: &Samples<'_>, receivers: impl Iterator<Item = usize>) -> Wrong {
    let mut counts = Wrong::default();
    for (bin, n_dot_l) in counts.acne_by_n_dot_l.iter_mut().zip(N_DOT_L_BINS) {
        bin.n_dot_l_above = n_dot_l;
    }
    for pixel in receivers {
        let wrong = samples.is_wrong(pixel);
        let acne = wrong && !samples.is_truly_dark(pixel);
        counts.receivers += 1;
        counts.wrong += usize::from(wrong);
        counts.acne += usize::from(acne);
        let n_dot_l = samples.images.n_dot_l[pixel];
        if let Some(bin) = counts.acne_by_n_dot_l.iter_mut().rfind(|bin| n_dot_l > bin.n_dot_l_above) {
            bin.receivers += 1;
            bin.acne += usize::from(acne);
        }
    }
    counts.leak = counts.wrong - counts.acne;
    counts.misclassified_percent = percent(counts.wrong, counts.receivers);
    counts.acne_percent = percent(counts.acne, counts.receivers);
    counts.leak_percent = percent(counts.leak, counts.receivers);
    for bin in &mut counts.acne_by_n_dot_l {
        bin.acne_percent = percent(bin.acne, bin.receivers);
    }
    counts
}
