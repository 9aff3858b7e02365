//! What users choose of `sdsm`.

use serde::{Deserialize, Serialize};

use crate::settings::in_range;
use crate::{Error, TechniqueSettings};

/// Settings of the technique `sdsm`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SdsmSettings {
    /// Where cascades end in the range of what is seen: 0 at equal distances, 1 at equal ratios, and between.
    pub lambda: f32,
    /// How much shorter nearer cascades are than that: of n cascades the i-th ends at the part (i / n)^nearness of the range. 0.5 to 4;
    /// 1: no shorter. Most pixels show what is near.
    pub nearness: f32,
}

impl Default for SdsmSettings {
    fn default() -> Self {
        Self { lambda: 1.0, nearness: 1.4 }
    }
}

impl TechniqueSettings for SdsmSettings {
    const NAME: &'static str = "sdsm";

    fn validate(&self) -> Result<(), Error> {
        in_range("lambda", self.lambda, 0.0, 1.0, "0 to 1")?;
        in_range("nearness", self.nearness, 0.5, 4.0, "0.5 to 4")
    }
}
