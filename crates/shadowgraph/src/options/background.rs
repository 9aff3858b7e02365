//! What is drawn behind a scene.

use super::color;
use super::error::OptionError;
use crate::background::Background;
use std::str::FromStr;

const OPTION: &str = "background";

impl FromStr for Background {
    type Err = OptionError;

    /// ```
    /// use shadowgraph::Background;
    /// assert_eq!("transparent".parse(), Ok(Background::Transparent));
    /// assert_eq!("#ffffff".parse(), Ok(Background::Color(glam::Vec3::ONE)));
    /// ```
    fn from_str(text: &str) -> Result<Self, OptionError> {
        match text {
            "sky" => Ok(Self::Sky),
            "transparent" => Ok(Self::Transparent),
            _ => color::parse(OPTION, text, "sky, transparent").map(Self::Color),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn an_invalid_background_is_refused_with_what_is_expected() {
        for text in ["", "blue", "#fff", "#12345g", "1,2,3", "0,0", "#-12345", "0,0,nan"] {
            assert_eq!(
                text.parse::<Background>().unwrap_err().to_string(),
                format!(
                    "background: invalid value `{text}`; expected sky, transparent, #RRGGBB, or R,G,B (linear, each 0 to 1)"
                )
            );
        }
    }
}
