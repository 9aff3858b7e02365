//! Words for what `page_explanation.wgsl` finds at a point.

use crate::explained_lookup;
use crate::technique::{ExplanationValues, ShadowFact};

/// Returns the page that a point is read from, and the lookup there.
pub(super) fn describe(values: &ExplanationValues) -> Vec<ShadowFact> {
    explained_lookup::describe(values, |own| {
        let &[level, wanted, coarsening, face, x, y, left, top, is_drawn, ..] = own else {
            return Vec::new();
        };
        let drawn =
            if is_drawn == 1.0 { "page drawn in this frame" } else { "page kept from an earlier frame" };
        vec![
            ShadowFact::new("level", [level], ""),
            ShadowFact::new("level that the pixel needs", [wanted], "levels"),
            ShadowFact::new("coarser for lack of pages by", [coarsening], "levels"),
            ShadowFact::new("face of the light", [face], ""),
            ShadowFact::new(drawn, [x, y], ""),
            ShadowFact::new("place in the pool", [left, top], "texels"),
        ]
    })
}
