//! The draws that fill a tile of the store of static casters.

use super::contents::{Fill, Work};
use super::draw::Source;
use super::queries::{Queries, TileCasters};
use super::scroll::{self, Piece};
use super::tile::{Tile, culled_by, statics};
use crate::tile_fit::TileFit;
use crate::views::ShadowView;

/// The draws into the tiles of the store in a frame.
#[derive(Default)]
pub(super) struct Fills<'t> {
    pub(super) draws: Vec<TileFill<'t>>,
    /// The views of the draws.
    pub(super) views: Vec<ShadowView>,
}

/// The draws into a tile of the store.
pub(super) struct TileFill<'t> {
    pub(super) tile: &'t Tile<'t>,
    pub(super) fill: &'t Fill,
    pub(super) draws: Vec<StoreDraw>,
}

/// The draws into a part of it without a wrap.
pub(super) struct StoreDraw {
    pub(super) piece: Piece,
    /// Index of the view in the buffer of this map's pieces.
    pub(super) view: u32,
    /// Whether the piece is cleared first.
    pub(super) clears: bool,
    pub(super) casters: TileCasters,
}

impl<'t> Fills<'t> {
    /// Returns the draws of what is missing in the store.
    pub(super) fn new(tiles: &'t [Tile<'t>], source: Source<'_, '_>, queries: &mut Queries) -> Self {
        let mut fills = Self::default();
        for tile in tiles {
            if let Work::OverStore(fill) = &tile.work
                && *fill != (Fill { anchor: fill.anchor, ..Fill::default() })
            {
                let draws = draws(tile, fill, source, &mut fills.views, queries);
                fills.draws.push(TileFill { tile, fill, draws });
            }
        }
        fills
    }
}

/// Returns the draws of what is missing in a tile of the store.
fn draws(
    tile: &Tile<'_>,
    fill: &Fill,
    source: Source<'_, '_>,
    views: &mut Vec<ShadowView>,
    queries: &mut Queries,
) -> Vec<StoreDraw> {
    let (rect, first) = (tile.plan.rect, tile.wanted.location.first_texel);
    let view = &source.views.1[tile.plan.view as usize];
    let window = scroll::Texels { first, size: [rect.width, rect.height] };
    let mut draws = Vec::new();
    let mut push = |texels, clears, casters: &TileCasters| {
        for piece in scroll::pieces(&rect, fill.anchor, first, texels) {
            draws.push(StoreDraw { piece, view: views.len() as u32, clears, casters: casters.clone() });
            // Noise stays in place in the world.
            let corner = [rect.x, rect.y];
            let moved = [0, 1].map(|axis| {
                let noise = i64::from(view.noise_px[axis]) + i64::from(corner[axis]) - piece.tile_at[axis];
                noise.rem_euclid(1024) as u32
            });
            views.push(ShadowView { noise_px: moved, ..*view });
        }
    };
    let is_culled = culled_by(tile.plan, source).is_some();
    for strip in &fill.strips {
        let casters = match tile.plan.fit {
            TileFit::Directional(fit) if *strip != window => {
                let volume = fit.texels_volume(strip.first, strip.size, 1.0).into();
                if is_culled {
                    TileCasters::all_static(tile.plan, &tile.whole, &volume, queries)
                } else {
                    TileCasters::all_static(tile.plan, &statics(source.casters, &volume), &volume, queries)
                }
            }
            _ => TileCasters::all_static(tile.plan, &tile.whole, &tile.plan.fit.volume(), queries),
        };
        push(strip, true, &casters);
    }
    if !fill.added.is_empty() {
        push(&window, false, &TileCasters::listed(fill.added.clone()));
    }
    draws
}
