//! Values that textures should not have: NaN, infinities, and what is outside of their ranges.

use crate::handle::{PassId, ResourceId};
use crate::plan::Plan;
use std::fmt::Write;
use std::ops::RangeInclusive;

/// Which values a check reports: NaN and infinities, depth that is not from 0 to 1, and what is outside of ranges that are declared here.
///
/// ```
/// use shadowgraph_core::ValueCheck;
/// let check = ValueCheck::default().range("exposure", 1e-4..=1e4);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValueCheck {
    ranges: Vec<(String, RangeInclusive<f32>)>,
}

impl ValueCheck {
    /// Reports values of all channels, alpha too, outside of `range`, in textures with this name or path that are not integers.
    #[must_use]
    pub fn range(mut self, texture: impl Into<String>, range: RangeInclusive<f32>) -> Self {
        self.ranges.push((texture.into(), range));
        self
    }

    /// Returns the range of a texture with a name and a path, if one is declared.
    #[cfg(feature = "gpu")]
    pub(crate) fn range_of(&self, name: &str, path: &str) -> Option<RangeInclusive<f32>> {
        let mut declared = self.ranges.iter().rev();
        declared.find(|(texture, _)| texture == name || texture == path).map(|(_, range)| range.clone())
    }
}

/// What a check of a frame has found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ValueReport {
    /// The versions of textures with values that they should not have, in the order of the passes that wrote them.
    pub bad: Vec<BadValues>,
    /// Textures that could not be checked, with the reason.
    pub unchecked: Vec<(ResourceId, String)>,
}

/// Values that a mip level of a texture should not have after a pass.
#[derive(Clone, Debug, PartialEq)]
pub struct BadValues {
    /// The pass that wrote them.
    pub pass: PassId,
    /// Number of texels with NaN in a channel.
    pub nan: u32,
    /// Number of other texels with an infinity.
    pub infinite: u32,
    /// Number of other texels outside of the range.
    pub outside: u32,
    /// The range that is allowed.
    pub range: RangeInclusive<f32>,
    /// The first of these texels, row by row and layer by layer.
    pub first: Texel,
    /// Texels at the same place of textures of the same shape that the pass read: for images of half the size, at half the coordinates.
    pub inputs: Vec<Texel>,
}

/// A texel and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Texel {
    /// The texture.
    pub texture: ResourceId,
    /// Its version.
    pub version: u32,
    /// The mip level.
    pub mip: u32,
    /// The place in the mip level: from the left, from the top, and the layer.
    pub at: [u32; 3],
    /// A value for each channel.
    pub value: Vec<f64>,
}

impl ValueReport {
    /// Returns a text of some lines: the first pass with bad values, its inputs there, and the later ones. Empty if there is nothing to
    /// report. `plan` is that of the checked frame.
    pub fn to_text(&self, plan: &Plan) -> String {
        let mut text = String::new();
        let mut bad = self.bad.iter();
        if let Some(first) = bad.next() {
            let _ = writeln!(text, "{}", first.sentence(plan));
            let _ = writeln!(text, "  there: {}", first.first.describe(plan));
            for input in &first.inputs {
                let _ = writeln!(text, "  read:  {}", input.describe(plan));
            }
        }
        for later in bad {
            let _ = writeln!(text, "later: {}", later.sentence(plan));
        }
        for (texture, reason) in &self.unchecked {
            let _ = writeln!(text, "not checked: `{}`: {reason}", plan.resource(*texture).name);
        }
        text
    }
}

impl BadValues {
    fn sentence(&self, plan: &Plan) -> String {
        let range = format!("outside of {} to {}", self.range.start(), self.range.end());
        let kinds = [(self.nan, "NaN"), (self.infinite, "infinite"), (self.outside, range.as_str())];
        let counted: Vec<String> = kinds
            .iter()
            .filter(|(count, _)| *count > 0)
            .map(|(count, kind)| format!("{count} {} {kind}", if *count == 1 { "texel" } else { "texels" }))
            .collect();
        let Texel { texture, version, mip, .. } = &self.first;
        let mip = if *mip > 0 { format!(", mip {mip}") } else { String::new() };
        format!(
            "`{}` wrote `{}` v{version}{mip}: {}",
            plan.pass_path(self.pass),
            plan.resource(*texture).name,
            counted.join(", ")
        )
    }
}

impl Texel {
    fn describe(&self, plan: &Plan) -> String {
        let [x, y, layer] = self.at;
        let layers = if layer > 0 { format!(", layer {layer}") } else { String::new() };
        let mip = if self.mip > 0 { format!(", mip {}", self.mip) } else { String::new() };
        // Integers are exact; others were `f32`.
        let number = |&value: &f64| match value.fract() == 0.0 {
            true => value.to_string(),
            false => (value as f32).to_string(),
        };
        let values: Vec<String> = self.value.iter().map(number).collect();
        let name = plan.resource(self.texture).name;
        format!("`{name}` v{} at {x},{y}{layers}{mip}: {}", self.version, values.join(" "))
    }
}
