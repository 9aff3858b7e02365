//! A tile of a kept map in a frame, and what has to be drawn into it.

use std::cell::OnceCell;

use shadowgraph_scene::CullVolume;

use super::cache::CachedMap;
use super::contents::{self, Fill, Held, Location, Stored, StoredCaster, Versions, Wanted, Work};
use super::draw::{MapTexture, Source};
use super::reasons::reason;
use super::restore::RestoreBlock;
use super::scroll;
use crate::casters::{CasterPass, Mobility, ShadowCasters};
use crate::plan::TilePlan;

/// A tile of a kept map in a frame.
pub(super) struct Tile<'p> {
    pub(super) plan: &'p TilePlan,
    pub(super) wanted: Wanted,
    /// The static casters in the whole tile, if they were needed.
    pub(super) whole: Versions,
    pub(super) work: Work,
    pub(super) reason: String,
}

/// Decides what has to be drawn into a tile.
pub(super) fn plan_tile<'p>(
    cached: &CachedMap,
    map: &MapTexture<'_>,
    tile: &'p TilePlan,
    source: Source<'_, '_>,
) -> Tile<'p> {
    let casters = source.casters;
    let location = Location::new(tile, &source.views.1[tile.view as usize], source.origin_world);
    let mut wanted = Wanted { location, seen: Vec::new(), moving: Vec::new() };
    // Opaque casters hide tints.
    let hides = map.pass == CasterPass::Tint && !tile.tints.is_empty();
    let hiding = if hides { &tile.casters[..] } else { &[] };
    for &caster in tile.casters_of(map.pass).iter().chain(hiding) {
        let is_kept_apart = map.pass == CasterPass::Depth;
        match casters.version(caster) {
            Some(version) if !is_kept_apart || casters.mobility(caster) == Mobility::Static => {
                wanted.seen.push((caster, version));
            }
            version => wanted.moving.push((caster, version)),
        }
    }
    cached.with_tile(tile.rect, |held, stored| {
        let whole = OnceCell::new();
        let work = if map.pass == CasterPass::Depth {
            let all = || whole.get_or_init(|| statics(casters, &tile.fit.volume()));
            contents::work(tile, held, stored, &wanted, &all, &|caster| casters.caster_bounds(caster))
        } else {
            contents::work_of_tints(held, &wanted)
        };
        let static_count = whole.get().map_or(wanted.seen.len(), Vec::len);
        let reason = reason(&work, held, &wanted, static_count, casters);
        Tile { plan: tile, whole: whole.into_inner().unwrap_or_default(), reason, work, wanted }
    })
}

/// Returns the static opaque casters in a volume, and their versions.
pub(super) fn statics(casters: &dyn ShadowCasters, volume: &CullVolume) -> Versions {
    let mut found = Vec::new();
    casters.cull(volume, &mut found);
    let version = |caster| {
        let is_static = casters.mobility(caster) == Mobility::Static && !casters.tints(caster);
        Some((caster, casters.version(caster).filter(|_| is_static)?))
    };
    found.into_iter().filter_map(version).collect()
}

impl Tile<'_> {
    /// Returns whether nothing is drawn into a cleared tile.
    pub(super) fn is_empty(&self, map: &MapTexture<'_>) -> bool {
        self.casters(map.pass).is_empty()
    }

    pub(super) fn is_whole(&self) -> bool {
        match self.work {
            Work::All { whole, .. } => whole,
            Work::OverStore(_) => true,
            Work::Nothing => false,
        }
    }

    /// Returns the casters that are drawn into the map.
    pub(super) fn casters(&self, pass: CasterPass) -> Vec<u32> {
        let moving = self.wanted.moving.iter().map(|(caster, _)| *caster);
        match self.work {
            Work::Nothing => Vec::new(),
            Work::OverStore(_) => moving.collect(),
            Work::All { whole: true, .. } => {
                self.whole.iter().map(|(caster, _)| *caster).chain(moving).collect()
            }
            Work::All { whole: false, .. } => self.plan.casters_of(pass).to_vec(),
        }
    }

    /// Returns what the tile of the map holds once it has been drawn.
    pub(super) fn held(&self) -> Held {
        let whole = self.is_whole();
        let statics = if whole { &self.whole } else { &self.wanted.seen };
        let Wanted { location, moving, .. } = &self.wanted;
        Held { location: location.clone(), whole, statics: statics.clone(), moving: moving.clone() }
    }

    /// Returns what the tile of the store holds once it has been filled.
    pub(super) fn stored(&self, fill: &Fill, casters: &dyn ShadowCasters) -> Stored {
        let stored = |&(caster, version): &(u32, u64)| StoredCaster {
            caster,
            version,
            bounds: casters.caster_bounds(caster),
        };
        Stored {
            location: self.wanted.location.clone(),
            anchor: fill.anchor,
            casters: self.whole.iter().map(stored).collect(),
        }
    }

    pub(super) fn restore_block(&self, fill: &Fill) -> RestoreBlock {
        let rect = self.plan.rect;
        RestoreBlock {
            tile_px: [rect.x, rect.y, rect.width, rect.height],
            wrap_px: scroll::wrap(&rect, fill.anchor, self.wanted.location.first_texel),
            padding: [0; 2],
        }
    }
}
