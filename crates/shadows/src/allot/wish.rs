//! What a light asks for.

use std::cmp::Ordering;

/// The most tiles that an owner may wish for.
pub(crate) const MAX_TILES: u32 = 32;

/// A light's wish for tiles in a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileWish {
    /// The light: its index, or any other number that it alone has. Of wishes with the same owner only the most
    /// important one counts.
    pub owner: u32,
    /// How many tiles, all of the same size: 1 to 32. All are granted or none. A wish
    /// for none is left out, one for more is refused and stands in nobody's way.
    pub tiles: u32,
    /// Wished width of a tile, pixels. It is kept between the smallest and the largest; the smallest is taken for
    /// what is not finite.
    pub size_px: f64,
    /// The more, the earlier it is served. At the same importance the lower owner comes first. What is not finite
    /// is less than everything else.
    pub importance: f64,
}

impl TileWish {
    fn cleaned(&self) -> Self {
        let importance = if self.importance.is_finite() { self.importance } else { f64::NEG_INFINITY };
        // Adding zero makes negative zero positive, so that the two are equally important.
        Self { importance: importance + 0.0, ..*self }
    }

    fn by_owner(&self, other: &Self) -> Ordering {
        let then = self.owner.cmp(&other.owner).then(other.importance.total_cmp(&self.importance));
        then.then(other.size_px.total_cmp(&self.size_px)).then(other.tiles.cmp(&self.tiles))
    }
}

/// Returns the wishes that count, by owner.
pub(super) fn clean(wishes: &[TileWish]) -> Vec<TileWish> {
    let mut clean: Vec<TileWish> =
        wishes.iter().filter(|wish| wish.tiles > 0).map(TileWish::cleaned).collect();
    clean.sort_unstable_by(TileWish::by_owner);
    clean.dedup_by_key(|wish| wish.owner);
    clean
}
