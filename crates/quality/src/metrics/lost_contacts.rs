//! How much shadow is missing right where things touch.

use serde::{Deserialize, Serialize};

use super::Seen;
use super::statistics::percent;

/// Blockers nearer than this are near, metres.
pub const NEAR_BLOCKER_M: f32 = 0.25;

/// Truly dark receivers with a near blocker, and how many of them are lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LostContacts {
    /// How many there are: truly dark, the nearest blocker nearer than [`NEAR_BLOCKER_M`].
    pub contacts: usize,
    /// How many of them are lit: visibility above 1/2.
    pub lost: usize,
    /// `lost` in percent of `contacts`; 0 if there are none.
    pub lost_percent: f64,
}

/// Counts lost contacts, in the band and outside of it: contacts are where edges are.
#[must_use]
pub fn lost_contacts(seen: &Seen<'_>) -> LostContacts {
    let near = |pixel: &usize| seen.images.blocker_distances_m[*pixel] < NEAR_BLOCKER_M;
    let contacts = seen.receivers().filter(|&pixel| seen.is_truly_dark(pixel)).filter(near);
    let (contacts, lost) = contacts
        .fold((0, 0), |(contacts, lost), pixel| (contacts + 1, lost + usize::from(seen.is_wrong(pixel))));
    LostContacts { contacts, lost, lost_percent: percent(lost, contacts) }
}
