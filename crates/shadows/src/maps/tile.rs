//! A tile of a kept map in a frame, and what has to be drawn into it.

use std::cell::OnceCell;

use shadowgraph_scene::{Aabb, CullVolume};

use super::cache::CachedMap;
use super::contents::{
    self, ALL_STATIC, Fill, Held, Location, Statics, Stored, StoredCaster, VOLUME, Versions, Wanted, Work,
    number_of,
};
use super::draw::{MapTexture, Source};
use super::queries::{Queries, TileCasters};
use super::reasons::reason;
use super::restore::RestoreBlock;
use super::scroll;
use crate::caster_view::{CasterPass, TileKind};
use crate::casters::{Mobility, ShadowCasters};
use crate::gpu_casters::GpuCasters;
use crate::plan::TilePlan;

/// A tile of a kept map in a frame.
pub(super) struct Tile<'p> {
    pub(super) plan: &'p TilePlan,
    pub(super) wanted: Wanted,
    /// See [`GpuCasters::static_version`]; `None` for casters that the GPU does not cull.
    static_version: Option<u64>,
    /// The static casters in the whole tile, if they were needed.
    pub(super) whole: Versions,
    pub(super) work: Work,
    /// The casters that are drawn into the map.
    pub(super) casters: TileCasters,
    pub(super) reason: String,
}

/// Decides what has to be drawn into a tile.
pub(super) fn plan_tile<'p>(
    cached: &CachedMap,
    map: &MapTexture<'_>,
    tile: &'p TilePlan,
    source: Source<'_, '_>,
    queries: &mut Queries,
) -> Tile<'p> {
    let casters = source.casters;
    let gpu = culled_by(tile, source);
    let volume = tile.fit.volume();
    let static_version = casters.gpu().map(|gpu| {
        let version = gpu.static_version();
        cached.renew(tile.rect, version, |since| !gpu.has_changed(since, &volume));
        version
    });
    let wanted = wanted(map.pass, tile, source);
    cached.with_tile(tile.rect, |held, stored| {
        let whole = OnceCell::new();
        let all = || {
            whole.get_or_init(|| match gpu {
                Some(gpu) if gpu.any(&volume) => vec![(ALL_STATIC, gpu.static_version())],
                Some(_) => Vec::new(),
                None => {
                    let known = held.and_then(|held| held.statics_at(&wanted.location, static_version));
                    known.cloned().unwrap_or_else(|| statics(casters, &volume))
                }
            })
        };
        let count = || gpu.map_or_else(|| all().len(), GpuCasters::static_count);
        let bounds = |caster| bounds(casters, caster);
        let work = if map.pass == CasterPass::Depth {
            contents::work(tile, held, stored, &wanted, Statics { all: &all, count: &count, bounds: &bounds })
        } else {
            contents::work_of_tints(held, &wanted)
        };
        let static_count = match gpu {
            Some(gpu) => gpu.static_count(),
            None => whole.get().map_or(wanted.seen.len(), Vec::len),
        };
        let reason = reason(&work, held, &wanted, static_count, casters);
        let whole = whole.into_inner().unwrap_or_default();
        let drawn = drawn(map.pass, tile, &work, (&whole, &wanted), queries);
        Tile { plan: tile, static_version, whole, casters: drawn, reason, work, wanted }
    })
}

/// Returns the casters, if the GPU culls those of a tile.
pub(super) fn culled_by<'f>(tile: &TilePlan, source: Source<'_, 'f>) -> Option<&'f dyn GpuCasters> {
    source.casters.gpu().filter(|_| matches!(tile.kind, TileKind::Cascade(_)))
}

/// Returns the contents that a frame needs in a tile.
fn wanted(pass: CasterPass, tile: &TilePlan, source: Source<'_, '_>) -> Wanted {
    let casters = source.casters;
    let location = Location::new(tile, &source.views.1[tile.view as usize], source.origin_world);
    let mut wanted = Wanted { location, seen: Vec::new(), moving: Vec::new() };
    // Opaque casters hide tints.
    let hides = pass == CasterPass::Tint && !tile.tints.is_empty();
    let mut hiding = if hides { tile.casters.clone() } else { Vec::new() };
    let is_opaque = pass == CasterPass::Depth || hides;
    let culled = culled_by(tile, source).zip(tile.culled.as_ref()).filter(|_| is_opaque);
    if let Some((gpu, volume)) = culled {
        gpu.moving(volume, &mut hiding);
    }
    for &caster in tile.casters_of(pass).iter().chain(&hiding) {
        let is_kept_apart = pass == CasterPass::Depth;
        match casters.version(caster) {
            Some(version) if !is_kept_apart || casters.mobility(caster) == Mobility::Static => {
                wanted.seen.push((caster, version));
            }
            version => wanted.moving.push((caster, version)),
        }
    }
    if let Some((gpu, volume)) = culled {
        wanted.seen.extend([(VOLUME, number_of(volume)), (ALL_STATIC, gpu.static_version())]);
    }
    wanted
}

/// Returns the bounds of a caster, or of all.
fn bounds(casters: &dyn ShadowCasters, caster: u32) -> Aabb {
    if caster == ALL_STATIC { casters.bounds() } else { casters.caster_bounds(caster) }
}

/// Returns the casters that are drawn into the map.
fn drawn(
    pass: CasterPass,
    tile: &TilePlan,
    work: &Work,
    (whole, wanted): (&Versions, &Wanted),
    queries: &mut Queries,
) -> TileCasters {
    let moving = wanted.moving.iter().map(|(caster, _)| *caster);
    match work {
        Work::Nothing => TileCasters::default(),
        Work::OverStore(_) => TileCasters::listed(moving.collect()),
        Work::All { whole: true, .. } => {
            let mut all = TileCasters::all_static(tile, whole, &tile.fit.volume(), queries);
            all.listed.extend(moving);
            all
        }
        Work::All { whole: false, .. } => TileCasters::seen(tile, pass, queries),
    }
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
    pub(super) fn is_whole(&self) -> bool {
        match self.work {
            Work::All { whole, .. } => whole,
            Work::OverStore(_) => true,
            Work::Nothing => false,
        }
    }

    /// Returns what the tile of the map holds once it has been drawn.
    pub(super) fn held(&self) -> Held {
        let whole = self.is_whole();
        let statics = if whole { &self.whole } else { &self.wanted.seen };
        let Wanted { location, moving, .. } = &self.wanted;
        Held {
            location: location.clone(),
            whole,
            static_version: self.static_version,
            statics: statics.clone(),
            moving: moving.clone(),
        }
    }

    /// Returns what the tile of the store holds once it has been filled.
    pub(super) fn stored(&self, fill: &Fill, casters: &dyn ShadowCasters) -> Stored {
        let stored = |&(caster, version): &(u32, u64)| StoredCaster {
            caster,
            version,
            bounds: bounds(casters, caster),
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
