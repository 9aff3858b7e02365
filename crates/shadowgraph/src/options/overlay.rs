//! Lines over images.

use super::error::OptionError;
use crate::shadow_lines::ShadowLines;
use std::str::FromStr;

impl FromStr for ShadowLines {
    type Err = OptionError;

    /// ```
    /// use shadowgraph::ShadowLines;
    /// assert_eq!("tiles".parse(), Ok(ShadowLines::Tiles));
    /// let error = "boxes".parse::<ShadowLines>().unwrap_err().to_string();
    /// assert_eq!(error, "overlay: invalid value `boxes`; expected frusta, spheres, tiles");
    /// ```
    fn from_str(text: &str) -> Result<Self, OptionError> {
        Self::from_name(text).ok_or_else(|| {
            let expected = Self::NAMES.join(", ");
            OptionError::new("overlay", format!("invalid value `{text}`; expected {expected}"))
        })
    }
}
