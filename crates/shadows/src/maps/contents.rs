//! What a tile holds, and what has to be drawn so that it holds what a frame needs.

use std::hash::{DefaultHasher, Hash, Hasher};

use glam::{DVec3, Mat4};
use shadowgraph_scene::{Aabb, CullVolume};

use super::scroll::{self, Texels};
use crate::plan::TilePlan;
use crate::tile_fit::TileFit;
use crate::views::ShadowView;

/// The number that stands for all static casters of a volume that the GPU culls; their version is that of all.
pub(super) const ALL_STATIC: u32 = u32::MAX;
/// The number that stands for the volume; its version is [`number_of`] it.
pub(super) const VOLUME: u32 = ALL_STATIC - 1;

/// Casters and their versions, in ascending order.
pub(super) type Versions = Vec<(u32, u64)>;

/// Distance into a texel, in texels, up to which a caster cannot draw it: half of one is needed, and rounding is less.
const INSIDE: f64 = 0.25;

/// The position of a tile's texels in the world.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Location {
    /// The matrix of the view, without what moves it by whole texels.
    clip_from_world: Mat4,
    origin_world: DVec3,
    slope_bias_milli: u32,
    /// See [`OrthoFit::first_texel`](crate::OrthoFit::first_texel); zero for tiles that do not move so.
    pub(super) first_texel: [i64; 2],
}

impl Location {
    pub(super) fn new(tile: &TilePlan, view: &ShadowView, origin_world: DVec3) -> Self {
        let mut clip_from_world = view.clip_from_world;
        let first_texel = match tile.fit {
            TileFit::Directional(fit) => {
                clip_from_world.w_axis.x = 0.0;
                clip_from_world.w_axis.y = 0.0;
                fit.first_texel()
            }
            TileFit::Local(_) => [0; 2],
        };
        Self { clip_from_world, origin_world, slope_bias_milli: tile.slope_bias_milli, first_texel }
    }

    /// Returns whether the other place is the same or differs by whole texels only.
    fn is_scrolled(&self, other: &Self) -> bool {
        let kept =
            |location: &Self| (location.clip_from_world, location.origin_world, location.slope_bias_milli);
        kept(self) == kept(other)
    }
}

/// The contents that a frame needs in a tile.
#[derive(Clone, Debug)]
pub(super) struct Wanted {
    pub(super) location: Location,
    /// The static casters that matter to the frame's view.
    pub(super) seen: Versions,
    /// The moving casters that do, and their versions if they have one.
    pub(super) moving: Vec<(u32, Option<u64>)>,
}

impl Wanted {
    /// Returns whether no caster matters to the frame.
    pub(super) fn is_empty(&self) -> bool {
        self.seen.is_empty() && self.moving.is_empty()
    }
}

/// The contents of a tile of a map.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Held {
    pub(super) location: Location,
    /// Whether `statics` are those in the whole tile, not those that mattered to one view.
    pub(super) whole: bool,
    /// The version of all static casters when `statics` were found, if they have one.
    pub(super) static_version: Option<u64>,
    pub(super) statics: Versions,
    pub(super) moving: Vec<(u32, Option<u64>)>,
}

impl Held {
    /// Returns the static casters in the whole tile at this location, if they are known at this version of all.
    pub(super) fn statics_at(&self, location: &Location, static_version: Option<u64>) -> Option<&Versions> {
        let is_same = static_version.is_some() && self.static_version == static_version;
        (self.whole && is_same && self.location == *location).then_some(&self.statics)
    }
}

/// The contents of a tile of the store of static casters.
#[derive(Clone, Debug)]
pub(super) struct Stored {
    pub(super) location: Location,
    /// The texel of the world at the tile's top left: texels to its left and above it wrap around.
    pub(super) anchor: [i64; 2],
    pub(super) casters: Vec<StoredCaster>,
}

/// A caster when it was drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct StoredCaster {
    pub(super) caster: u32,
    pub(super) version: u64,
    pub(super) bounds: Aabb,
}

/// What has to be drawn into a tile.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Work {
    /// Nothing.
    Nothing,
    /// All casters: the static ones in the whole tile, or those that matter to the view.
    All { whole: bool, because: Because },
    /// What is missing in the store, and over a copy of it the moving casters.
    OverStore(Fill),
}

/// Reason why a tile is drawn with all casters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Because {
    /// Nothing that it held can be used.
    New,
    /// Its light has moved, or it has been fitted to another range.
    Refitted,
    /// Static casters have changed, or others matter to the view.
    Changed,
    /// There are more moving casters than static ones.
    Moving,
    /// Translucent casters, or those that hide them, have changed.
    Hidden,
}

/// What is missing in a tile of the store.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Fill {
    /// The texel of the world at the tile's top left from now on.
    pub(super) anchor: [i64; 2],
    /// Whether the whole tile is drawn again.
    pub(super) is_all: bool,
    /// Where all static casters are drawn.
    pub(super) strips: Vec<Texels>,
    /// The casters that are added to the rest.
    pub(super) added: Vec<u32>,
}

/// The static casters in a whole tile.
#[derive(Clone, Copy)]
pub(super) struct Statics<'w> {
    /// Returns them.
    pub(super) all: &'w dyn Fn() -> &'w Versions,
    /// Returns their number.
    pub(super) count: &'w dyn Fn() -> usize,
    /// Returns the bounds of one.
    pub(super) bounds: &'w dyn Fn(u32) -> Aabb,
}

/// Returns a number for the planes of a volume.
pub(super) fn number_of(volume: &CullVolume) -> u64 {
    let mut hasher = DefaultHasher::new();
    for plane in &volume.planes.planes {
        plane.normal.to_array().map(f64::to_bits).hash(&mut hasher);
        plane.distance.to_bits().hash(&mut hasher);
    }
    hasher.finish()
}

/// Decides what has to be drawn into a tile.
pub(super) fn work(
    tile: &TilePlan,
    held: Option<&Held>,
    stored: Option<&Stored>,
    wanted: &Wanted,
    statics: Statics<'_>,
) -> Work {
    let Some(held) = held else { return Work::All { whole: false, because: Because::New } };
    if held.statics.is_empty() && held.moving.is_empty() && wanted.is_empty() {
        return Work::Nothing;
    }
    if !held.location.is_scrolled(&wanted.location) {
        return Work::All { whole: false, because: Because::Refitted };
    }
    let stays = held.location == wanted.location;
    let rests = held.moving == wanted.moving && held.moving.iter().all(|(_, version)| version.is_some());
    if stays && rests && !held.whole && held.statics == wanted.seen {
        return Work::Nothing;
    }
    let whole = (statics.all)();
    if stays && rests && held.whole && held.statics == *whole {
        return Work::Nothing;
    }
    if stays && wanted.moving.is_empty() && stored.is_none() {
        return Work::All { whole: true, because: Because::Changed };
    }
    if (statics.count)() < wanted.moving.len().max(1) {
        return Work::All { whole: false, because: Because::Moving };
    }
    Work::OverStore(fill(tile, stored, &wanted.location, whole, statics.bounds))
}

/// Decides the same for tints and their depths: they depend on the opaque casters that hide them, and are drawn again as a whole.
pub(super) fn work_of_tints(held: Option<&Held>, wanted: &Wanted) -> Work {
    let because = match held {
        None => Because::New,
        Some(held) if held.location != wanted.location => Because::Refitted,
        Some(held) if held.statics != wanted.seen || !wanted.moving.is_empty() => Because::Hidden,
        Some(_) => return Work::Nothing,
    };
    Work::All { whole: false, because }
}

/// Returns what is missing in the store.
fn fill(
    tile: &TilePlan,
    stored: Option<&Stored>,
    location: &Location,
    whole: &Versions,
    bounds: &dyn Fn(u32) -> Aabb,
) -> Fill {
    let size = [tile.rect.width, tile.rect.height];
    let window = Texels { first: location.first_texel, size };
    let all = Fill { anchor: location.first_texel, is_all: true, strips: vec![window], added: Vec::new() };
    let Some(stored) = stored.filter(|stored| stored.location.is_scrolled(location)) else { return all };
    let before = Texels { first: stored.location.first_texel, size };
    let Some(common) = before.common(&window) else { return all };
    let is_in_common = |bounds: &Aabb| match tile.fit {
        TileFit::Directional(fit) => fit.texels_volume(common.first, common.size, -INSIDE).intersects(bounds),
        TileFit::Local(_) => true,
    };
    let mut new = whole.iter().copied().peekable();
    let mut added = Vec::new();
    for old in &stored.casters {
        while let Some((caster, _)) = new.next_if(|(caster, _)| *caster < old.caster) {
            added.push(caster);
        }
        let same = new.next_if(|(caster, _)| *caster == old.caster);
        if same.is_some_and(|(_, version)| version == old.version) {
            continue;
        }
        if is_in_common(&old.bounds) {
            // Depth that a caster has drawn cannot be taken back.
            return all;
        }
        added.extend(same.map(|(caster, _)| caster));
    }
    added.extend(new.map(|(caster, _)| caster));
    if added.contains(&ALL_STATIC) {
        return all;
    }
    added.retain(|&caster| is_in_common(&bounds(caster)));
    Fill { anchor: stored.anchor, is_all: false, strips: scroll::entering(&before, &window), added }
}
