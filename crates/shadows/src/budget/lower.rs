//! What a level leaves of settings.

use super::Quality;
use super::splits;
use crate::{AtlasSettings, AtlasTiles, CascadeSettings, ShadowSettings};

/// The least that settings can have.
const MIN_DISTANCE_M: f32 = 0.001;
const MIN_MAP_PX: u32 = 256;
const MIN_TILE_PX: u32 = 64;

pub(super) fn lowered(settings: &ShadowSettings, quality: &Quality) -> ShadowSettings {
    let mut lowered = settings.clone();
    // Their error is for whoever uses them, in the user's own numbers.
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

fn lower_cascades(cascades: &mut CascadeSettings, quality: &Quality, shorter: bool, distance_m: f32) {
    cascades.map_size_px = smaller_map(cascades.map_size_px, quality.map_scale);
    if shorter || cascades.count > quality.cascades {
        splits::drop_beyond(cascades, distance_m);
        splits::cut(cascades, quality.cascades, distance_m);
        // Those of no cascade would still widen the tiles' borders.
        cascades.bias_scales.truncate(cascades.count as usize);
    }
}

/// As many tiles as before, as long as they are not too small.
fn lower_atlas(atlas: &mut AtlasSettings, map_scale: u32) {
    atlas.map_size_px = smaller_map(atlas.map_size_px, map_scale);
    if let AtlasTiles::ByImportance { smallest_px } = &mut atlas.tiles {
        *smallest_px = (*smallest_px / map_scale).max(MIN_TILE_PX);
    }
}

fn smaller_map(size_px: u32, scale: u32) -> u32 {
    (size_px / scale).max(MIN_MAP_PX)
}
