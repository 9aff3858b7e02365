//! Missing contact shadows.

use serde::{Deserialize, Serialize};

use super::Samples;
use super::statistics::percent;

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
