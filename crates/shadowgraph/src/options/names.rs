//! `--pipeline`: what exists by name.

use super::OptionError;
use std::str::FromStr;

/// The names of the built-in pipelines, the default first.
pub const PIPELINES: &[&str] = &["forward", "screen_shadows", "minimal"];

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

impl FromStr for Pipeline {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        let all = [Self::Forward, Self::ScreenShadows, Self::Minimal];
        all.into_iter().find(|pipeline| pipeline.name() == text).ok_or_else(|| {
            let reason = format!("there is no pipeline `{text}`; there is: {}", PIPELINES.join(", "));
            OptionError::new("--pipeline", reason)
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn the_default_is_the_first_of_the_list() {
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
