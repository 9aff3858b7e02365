//! The output that the image shows.

use super::error::OptionError;
use std::fmt;
use std::str::FromStr;

const OPTION: &str = "aov";

/// The output that the image shows (AOV: arbitrary output variable).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Aov {
    /// The finished image.
    #[default]
    Color,
    /// The visibility of a light by index: 8 bit grey (255 lit, 0 in shadow) and alpha (0 where nothing is drawn or the
    /// surface faces away from the light).
    Visibility(u32),
    /// The cascade of each pixel, or what else of the technique's maps it reads.
    Cascade,
    /// The level and the page of `virtual` that each pixel reads, darker where the page is kept from an earlier frame. Other techniques show
    /// [`Cascade`](Self::Cascade).
    Pages,
    /// The depth.
    Depth,
    /// The shading normal.
    Normal,
    /// The shadow atlas.
    Atlas,
    /// A texture of the graph by name.
    Texture(String),
}

impl Aov {
    /// The names that are not textures of the graph.
    pub(crate) const NAMES: [&str; 7] =
        ["color", "visibility:0", "cascade", "pages", "depth", "normal", "atlas"];
}

impl fmt::Display for Aov {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Color => f.write_str("color"),
            Self::Visibility(light) => write!(f, "visibility:{light}"),
            Self::Cascade => f.write_str("cascade"),
            Self::Pages => f.write_str("pages"),
            Self::Depth => f.write_str("depth"),
            Self::Normal => f.write_str("normal"),
            Self::Atlas => f.write_str("atlas"),
            Self::Texture(name) => f.write_str(name),
        }
    }
}

impl FromStr for Aov {
    type Err = OptionError;

    /// ```
    /// use shadowgraph::options::Aov;
    /// assert_eq!("depth".parse(), Ok(Aov::Depth));
    /// assert_eq!("visibility:0".parse(), Ok(Aov::Visibility(0)));
    /// assert_eq!("hdr".parse(), Ok(Aov::Texture("hdr".to_owned())));
    /// ```
    fn from_str(text: &str) -> Result<Self, OptionError> {
        let light = text.strip_prefix("visibility").filter(|rest| rest.is_empty() || rest.starts_with(':'));
        if let Some(light) = light {
            let number = light.trim_start_matches(':').parse().ok();
            let reason =
                format!("invalid value `{text}`; expected the index of a light, such as visibility:0");
            return number.map(Self::Visibility).ok_or_else(|| OptionError::new(OPTION, reason));
        }
        Ok(match text {
            "" => return Err(OptionError::new(OPTION, "empty value; the default is color")),
            "color" => Self::Color,
            "cascade" => Self::Cascade,
            "pages" => Self::Pages,
            "depth" => Self::Depth,
            "normal" => Self::Normal,
            "atlas" => Self::Atlas,
            name => Self::Texture(name.to_owned()),
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn every_name_is_parsed_from_its_display() {
        for text in [
            "color",
            "visibility:3",
            "cascade",
            "pages",
            "depth",
            "normal",
            "atlas",
            "shadow/cascades",
            "visibility_mask",
        ] {
            assert_eq!(text.parse::<Aov>().unwrap().to_string(), text);
        }
    }

    #[test]
    fn no_aov_name_is_parsed_as_a_texture() {
        for name in Aov::NAMES {
            assert!(!matches!(name.parse().unwrap(), Aov::Texture(_)), "{name}");
        }
    }

    #[test]
    fn visibility_without_the_index_of_a_light_is_refused() {
        for text in ["visibility", "visibility:", "visibility:sun", "visibility:-1", "visibility:99999999999"]
        {
            assert!(text.parse::<Aov>().unwrap_err().to_string().contains("such as visibility:0"), "{text}");
        }
    }
}
