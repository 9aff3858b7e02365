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
}

impl Default for SdsmSettings {
    fn default() -> Self {
        Self { lambda: 1.0 }
    }
}

impl TechniqueSettings for SdsmSettings {
    const NAME: &'static str = "sdsm";

    fn validate(&self) -> Result<(), Error> {
        in_range("lambda", self.lambda, 0.0, 1.0, "0 to 1")
    }
}
