//! Fewer cascades, where a user lists their ends.

use crate::{CascadeSettings, SplitScheme};

/// Leaves out the cascades that begin beyond the shadow distance, if ends are in metres.
pub(super) fn drop_beyond(cascades: &mut CascadeSettings, distance_m: f32) {
    let CascadeSettings { split: SplitScheme::Metres(ends), count, .. } = cascades else { return };
    ends.retain(|end| *end < distance_m);
    *count = (*count).min(ends.len() as u32 + 1);
}

/// Leaves at most `most` cascades, 1 to 8. No end is beyond the shadow distance.
pub(super) fn cut(cascades: &mut CascadeSettings, most: u32, distance_m: f32) {
    if cascades.count <= most {
        return;
    }
    cascades.count = most;
    let (ends, last) = match &mut cascades.split {
        SplitScheme::Ratios(ends) => (ends, 1.0),
        SplitScheme::Metres(ends) => (ends, distance_m),
        _ => return,
    };
    while ends.len() >= most as usize {
        let least = least_missed(ends, last);
        ends.remove(least);
        // What the cascade covered goes to the next, which keeps its bias.
        if least < cascades.bias_scales.len() {
            cascades.bias_scales.remove(least);
        }
    }
}

/// Which cascade's part of the view loses least when the next cascade covers it too: its texels grow by as much as that
/// one ends farther away. Of equals the farthest.
fn least_missed(ends: &[f32], last: f32) -> usize {
    let growth = |i: usize| ends.get(i + 1).unwrap_or(&last) / ends[i];
    (0..ends.len()).rev().min_by(|&a, &b| growth(a).total_cmp(&growth(b))).unwrap_or(0)
}
