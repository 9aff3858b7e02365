//! The shadow distance.

use super::error::OptionError;
use super::pairs::Range;
use std::str::FromStr;

const OPTION: &str = "shadow_distance";
const METRES: Range = Range::above(0.0, 1.0e6, "metres");

/// The distance from the camera that the sun's shadows reach.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum ShadowDistance {
    /// The end of the visible part of the scene's bounds, at most the far plane.
    #[default]
    Auto,
    /// A distance in metres, above 0.
    Metres(f64),
}

impl FromStr for ShadowDistance {
    type Err = OptionError;

    /// ```
    /// use shadowgraph::options::ShadowDistance;
    /// assert_eq!("auto".parse(), Ok(ShadowDistance::Auto));
    /// assert_eq!("80".parse(), Ok(ShadowDistance::Metres(80.0)));
    /// ```
    fn from_str(text: &str) -> Result<Self, OptionError> {
        if text == "auto" {
            return Ok(Self::Auto);
        }
        let metres = text.parse().ok().filter(|metres| METRES.contains(*metres));
        let reason = || format!("invalid value `{text}`; expected auto, or {METRES}");
        metres.map(Self::Metres).ok_or_else(|| OptionError::new(OPTION, reason()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn an_invalid_distance_is_refused_with_the_range() {
        for text in ["", "0", "-1", "NaN", "inf", "far", "1e7"] {
            let error = text.parse::<ShadowDistance>().unwrap_err().to_string();
            assert_eq!(
                error,
                format!(
                    "shadow_distance: invalid value `{text}`; expected auto, or above 0 to 1000000 metres"
                )
            );
        }
    }
}
