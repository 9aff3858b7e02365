//! `--technique` and `--pipeline`: what exists by name.

use super::OptionError;
use std::str::FromStr;

/// The names of the sun's shadow techniques, the default first.
pub const TECHNIQUES: &[&str] = &["pcf", "pcss", "raytraced", "none"];

/// The names of the built-in pipelines, the default first.
pub const PIPELINES: &[&str] = &["forward", "screen_shadows", "minimal"];

/// A shadow technique that exists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Technique {
    /// `pcf`: shadow maps, [`Pcf`](shadowgraph_shadows::Pcf).
    #[default]
    Pcf,
    /// `pcss`: shadow maps with edges that get softer with distance, [`Pcss`](shadowgraph_shadows::Pcss).
    Pcss,
    /// `raytraced`: a ray a pixel, [`Raytraced`](shadowgraph_shadows::Raytraced).
    Raytraced,
    /// `none`: everything is lit, [`NoShadows`](shadowgraph_shadows::NoShadows).
    None,
}

/// A built-in pipeline that exists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pipeline {
    /// `forward`: a depth prepass, then each pixel is lit once and asks for its shadows.
    #[default]
    Forward,
    /// `screen_shadows`: as `forward`, with shadows collected in a screen mask before anything is lit.
    ScreenShadows,
    /// `minimal`: everything that is drawn is lit, without a depth prepass.
    Minimal,
}

impl Technique {
    /// Returns its name, one of [`TECHNIQUES`].
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pcf => "pcf",
            Self::Pcss => "pcss",
            Self::Raytraced => "raytraced",
            Self::None => "none",
        }
    }
}

impl Pipeline {
    /// Returns its name, one of [`PIPELINES`].
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::ScreenShadows => "screen_shadows",
            Self::Minimal => "minimal",
        }
    }
}

impl FromStr for Technique {
    type Err = OptionError;

    /// ```
    /// use shadowgraph::options::Technique;
    /// assert_eq!("pcf".parse(), Ok(Technique::default()));
    /// let error = "soft".parse::<Technique>().unwrap_err();
    /// assert_eq!(error.to_string(), "--technique: there is no technique `soft`; there is: pcf, pcss, raytraced, none");
    /// ```
    fn from_str(text: &str) -> Result<Self, OptionError> {
        let all = [Self::Pcf, Self::Pcss, Self::Raytraced, Self::None];
        let name = known("--technique", "technique", text, TECHNIQUES)?;
        Ok(all.into_iter().find(|technique| technique.name() == name).unwrap_or_default())
    }
}

impl FromStr for Pipeline {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        let all = [Self::Forward, Self::ScreenShadows, Self::Minimal];
        let name = known("--pipeline", "pipeline", text, PIPELINES)?;
        Ok(all.into_iter().find(|pipeline| pipeline.name() == name).unwrap_or_default())
    }
}

fn known(
    option: &'static str,
    what: &str,
    text: &str,
    names: &[&'static str],
) -> Result<&'static str, OptionError> {
    let found = names.iter().find(|name| **name == text).copied();
    let reason = || format!("there is no {what} `{text}`; there is: {}", names.join(", "));
    found.ok_or_else(|| OptionError::new(option, reason()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn the_defaults_are_the_first_of_their_lists() {
        assert_eq!(Technique::default().name(), TECHNIQUES[0]);
        for name in TECHNIQUES {
            assert_eq!(name.parse::<Technique>().unwrap().name(), *name);
        }
        assert_eq!(Pipeline::default().name(), PIPELINES[0]);
        for name in PIPELINES {
            assert_eq!(name.parse::<Pipeline>().unwrap().name(), *name);
        }
    }

    #[test]
    fn an_unknown_name_is_refused_with_those_that_exist() {
        let error = "deferred".parse::<Pipeline>().unwrap_err().to_string();
        assert_eq!(
            error,
            "--pipeline: there is no pipeline `deferred`; there is: forward, screen_shadows, minimal"
        );
    }
}
