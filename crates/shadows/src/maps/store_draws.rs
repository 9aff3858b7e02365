//! The draws that fill a tile of the store of static casters.

use super::contents::Fill;
use super::draw::Source;
use super::scroll::{self, Piece};
use super::tile::{Tile, statics};
use crate::tile_fit::TileFit;
use crate::views::ShadowView;

/// The draws into a tile of the store.
pub(super) struct StoreDraws(pub(super) Vec<StoreDraw>);

/// The draws into a part of it without a wrap.
pub(super) struct StoreDraw {
    pub(super) piece: Piece,
    /// Index of the view in the buffer of this map's pieces.
    pub(super) view: u32,
    /// Whether the piece is cleared first.
    pub(super) clears: bool,
    pub(super) casters: Vec<u32>,
}

impl StoreDraws {
    pub(super) fn new(
        tile: &Tile<'_>,
        fill: &Fill,
        source: Source<'_, '_>,
        views: &mut Vec<ShadowView>,
    ) -> Self {
        let (rect, first) = (tile.plan.rect, tile.wanted.location.first_texel);
        let view = &source.views.1[tile.plan.view as usize];
        let window = scroll::Texels { first, size: [rect.width, rect.height] };
        let mut draws = Vec::new();
        let mut push = |texels, clears, casters: &[u32]| {
            for piece in scroll::pieces(&rect, fill.anchor, first, texels) {
                draws.push(StoreDraw { piece, view: views.len() as u32, clears, casters: casters.to_vec() });
                // Noise stays in place in the world.
                let corner = [rect.x, rect.y];
                let moved = [0, 1].map(|axis| {
                    let noise =
                        i64::from(view.noise_px[axis]) + i64::from(corner[axis]) - piece.tile_at[axis];
                    noise.rem_euclid(1024) as u32
                });
                views.push(ShadowView { noise_px: moved, ..*view });
            }
        };
        for strip in &fill.strips {
            let casters = match tile.plan.fit {
                TileFit::Directional(fit) if *strip != window => {
                    statics(source.casters, &fit.texels_volume(strip.first, strip.size, 1.0).into())
                }
                _ => tile.whole.clone(),
            };
            let casters: Vec<u32> = casters.into_iter().map(|(caster, _)| caster).collect();
            push(strip, true, &casters);
        }
        if !fill.added.is_empty() {
            push(&window, false, &fill.added);
        }
        Self(draws)
    }
}
