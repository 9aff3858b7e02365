//! How much shadow is missing right where things touch.

use serde::{Deserialize, Serialize};

use super::Samples;
use super::statistics::percent;

/// Blockers nearer than this are near, metres.
pub const NEAR_BLOCKER_M: f32 = 0.25;

/// Truly dark receivers with a near blocker, and how many of them are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MissingContacts {
    /// How many there are: truly dark, the nearest blocker nearer than [`NEAR_BLOCKER_M`].
    pub contacts: usize,
    /// How many of them are lit: visibility above 1/2.
    #[serde(rename = "lost")]
    pub missing: usize,
    /// `missing` in percent of `contacts`; 0 if there are none.
    #[serde(rename = "lost_percent")]
    pub missing_percent: f64,
}

/// Counts missing contacts, in the band and outside of it: contacts are where edges are.
#[must_use]
pub fn missing_contacts(samples: &Samples<'_>) -> MissingContacts {
    let near = |pixel: &usize| samples.images.blocker_distances_m[*pixel] < NEAR_BLOCKER_M;
    let contacts = samples.receivers().filter(|&pixel| samples.is_truly_dark(pixel)).filter(near);
    let (contacts, missing) = contacts.fold((0, 0), |(contacts, missing), pixel| {
        (contacts + 1, missing + usize::from(samples.is_wrong(pixel)))
    });
    MissingContacts { contacts, missing, missing_percent: percent(missing, contacts) }
}
