//! Settings limited by a quality level.

use super::config::QualityLevel;
use crate::settings::{AtlasSettings, AtlasTiles, CascadeSettings, ShadowSettings, SplitScheme};

/// The lower limits of what is lowered.
const MIN_DISTANCE_M: f32 = 0.001;
const MIN_MAP_PX: u32 = 256;
const MIN_TILE_PX: u32 = 64;

pub(super) fn lowered(settings: &ShadowSettings, quality: &QualityLevel) -> ShadowSettings {
    let mut lowered = settings.clone();
    // Whoever uses invalid settings reports the error, with the user's own numbers.
    if settings.validate().is_err() {
        return lowered;
    }
    lowered.distance_m = (settings.distance_m * quality.distance_scale).max(MIN_DISTANCE_M);
    lower_cascades(
        &mut lowered.cascades,
        quality,
        lowered.distance_m < settings.distance_m,
        lowered.distance_m,
    );
    lower_atlas(&mut lowered.atlas, quality.map_scale);
    lowered
}

fn lower_cascades(cascades: &mut CascadeSettings, quality: &QualityLevel, shorter: bool, distance_m: f32) {
    cascades.map_size_px = smaller_map(cascades.map_size_px, quality.map_scale);
    if shorter || cascades.count > quality.cascades {
        remove_beyond(cascades, distance_m);
        limit_count(cascades, quality.cascades, distance_m);
        // Scales of cascades that do not exist would still widen the tiles' borders.
        cascades.bias_scales.truncate(cascades.count as usize);
    }
}

/// Keeps the number of tiles, as long as they are not too small.
fn lower_atlas(atlas: &mut AtlasSettings, map_scale: u32) {
    atlas.map_size_px = smaller_map(atlas.map_size_px, map_scale);
    if let AtlasTiles::ByImportance { smallest_px } = &mut atlas.tiles {
        *smallest_px = (*smallest_px / map_scale).max(MIN_TILE_PX);
    }
}

fn smaller_map(size_px: u32, scale: u32) -> u32 {
    (size_px / scale).max(MIN_MAP_PX)
}

/// Removes the cascades that begin beyond the shadow distance, if ends are in metres.
fn remove_beyond(cascades: &mut CascadeSettings, distance_m: f32) {
    let CascadeSettings { split: SplitScheme::Metres(ends), count, .. } = cascades else { return };
    ends.retain(|end| *end < distance_m);
    *count = (*count).min(ends.len() as u32 + 1);
}

/// Keeps at most `most` cascades, 1 to 8. No end is beyond the shadow distance.
fn limit_count(cascades: &mut CascadeSettings, most: u32, distance_m: f32) {
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
        let removed = least_growth(ends, last);
        ends.remove(removed);
        // The next cascade covers the slice of the removed one, and keeps its own bias.
        if removed < cascades.bias_scales.len() {
            cascades.bias_scales.remove(removed);
        }
    }
}

/// Returns the cascade whose slice loses least when the next cascade covers it too: its texels grow by the ratio of
/// the two ends. Of equals the farthest.
fn least_growth(ends: &[f32], last: f32) -> usize {
    let growth = |i: usize| ends.get(i + 1).unwrap_or(&last) / ends[i];
    (0..ends.len()).rev().min_by(|&a, &b| growth(a).total_cmp(&growth(b))).unwrap_or(0)
}
