//! Words for what `mapped_explanation.wgsl` finds at a point.

use crate::explained_lookup;
use crate::technique::{ExplanationValues, ShadowFact};
use crate::views::MAP_CASCADES;

/// Returns the view that a point is read from, and the lookup there.
pub(super) fn describe(values: &ExplanationValues) -> Vec<ShadowFact> {
    explained_lookup::describe(values, |own| {
        let &[map, view, left, top, width, height, ..] = own else { return Vec::new() };
        let name = if map == MAP_CASCADES as f32 { "cascade" } else { "face of the light in the atlas" };
        vec![
            ShadowFact::new(name, [view], ""),
            ShadowFact::new("tile (left, top, width, height)", [left, top, width, height], "texels"),
        ]
    })
}
