//! What an allotment is made in.

/// The width of the map and the sizes that its tiles may have.
///
/// All three are powers of two; others are rounded down to one. Of sizes that contradict each other the map's holds
/// before the largest tile's, and that before the smallest one's; tiles are at least one pixel wide. In a map
/// without pixels every wish is refused.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct AllotRules {
    /// Width and height of the map, pixels.
    pub map_px: u32,
    /// Width and height of the smallest tiles, pixels.
    pub smallest_px: u32,
    /// Width and height of the largest tiles, pixels.
    pub largest_px: u32,
}

impl AllotRules {
    /// Returns the rules that hold for these, or `None` for a map without pixels.
    pub(super) fn sound(&self) -> Option<Self> {
        let map_px = power_of_two_within(self.map_px)?;
        let largest_px = power_of_two_within(self.largest_px.min(map_px)).unwrap_or(1);
        let smallest_px = power_of_two_within(self.smallest_px.min(largest_px)).unwrap_or(1);
        Some(Self { map_px, smallest_px, largest_px })
    }
}

fn power_of_two_within(px: u32) -> Option<u32> {
    px.checked_ilog2().map(|exponent| 1 << exponent)
}
