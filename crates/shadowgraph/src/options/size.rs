//! The size of an image.

use super::error::OptionError;
use std::fmt;
use std::str::FromStr;

const OPTION: &str = "size";

/// The size of an image in pixels, each side 1 to [`Size::MAX_PX`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Pixels from left to right.
    pub width_px: u32,
    /// Pixels from top to bottom.
    pub height_px: u32,
}

impl Size {
    /// The maximum of each side, pixels. An adapter may have a lower limit.
    pub const MAX_PX: u32 = 16_384;

    /// Returns the width divided by the height.
    #[must_use]
    pub fn aspect(self) -> f64 {
        f64::from(self.width_px) / f64::from(self.height_px)
    }
}

impl Default for Size {
    fn default() -> Self {
        Self { width_px: 1280, height_px: 720 }
    }
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width_px, self.height_px)
    }
}

impl FromStr for Size {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        let malformed =
            || OptionError::new(OPTION, format!("invalid value `{text}`; expected WxH, such as 1280x720"));
        let is_number = |text: &&str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        let sides =
            text.split_once(['x', 'X']).filter(|(width, height)| is_number(width) && is_number(height));
        let (width, height) = sides.ok_or_else(malformed)?;
        let side = |name: &str, text: &str| {
            let px = text.parse().ok().filter(|px| (1..=Self::MAX_PX).contains(px));
            let reason = || format!("{name} {text} is out of range: 1 to {} pixels", Self::MAX_PX);
            px.ok_or_else(|| OptionError::new(OPTION, reason()))
        };
        Ok(Self { width_px: side("width", width)?, height_px: side("height", height)? })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn a_size_is_parsed_from_its_display() {
        for text in ["1x1", "1280x720", "16384x16384"] {
            assert_eq!(text.parse::<Size>().unwrap().to_string(), text);
        }
    }

    #[test]
    fn what_is_not_two_numbers_is_refused() {
        for text in
            ["", "x", "1280", "1280x", "x720", "12.5x7", "-1x5", "+1x5", "1x2x3", "0x10x10", "1280 x 720"]
        {
            let error = text.parse::<Size>().unwrap_err().to_string();
            assert!(error.contains("WxH"), "{text}: {error}");
        }
    }

    #[test]
    fn a_side_out_of_range_is_named_with_the_range() {
        let error = "0x720".parse::<Size>().unwrap_err().to_string();
        assert_eq!(error, "size: width 0 is out of range: 1 to 16384 pixels");
        let error = "1x99999999999999999999".parse::<Size>().unwrap_err().to_string();
        assert!(error.contains("height 99999999999999999999 is out of range"), "{error}");
    }
}
