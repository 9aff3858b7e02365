//! The animations of the scene that are played, and the time.

use super::error::OptionError;
use super::pairs::Range;
use shadowgraph_scene::{AnimationSelection, Hierarchy};
use std::str::FromStr;

const OPTION: &str = "animation";
const TIME_OPTION: &str = "time";
const SECONDS: Range = Range::within(-1.0e9, 1.0e9, "seconds");

/// The animations that are played.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AnimationChoice {
    /// All at once.
    #[default]
    All,
    /// None: the scene is at rest.
    None,
    /// One of the scene, by its index, or else by its name.
    Scene(String),
}

impl AnimationChoice {
    /// Returns the animations of a scene.
    ///
    /// ```
    /// use shadowgraph::options::AnimationChoice;
    /// use shadowgraph_scene::{AnimationSelection, Hierarchy};
    /// let hierarchy = Hierarchy::default();
    /// assert_eq!("none".parse::<AnimationChoice>()?.resolve(&hierarchy)?, AnimationSelection::None);
    /// let error = "walk".parse::<AnimationChoice>()?.resolve(&hierarchy).unwrap_err();
    /// assert_eq!(error.to_string(), "animation: unknown animation `walk`; the scene has no animations");
    /// # Ok::<(), shadowgraph::options::OptionError>(())
    /// ```
    ///
    /// # Errors
    /// For an animation that the scene does not have; the message lists its animations.
    pub fn resolve(&self, hierarchy: &Hierarchy) -> Result<AnimationSelection, OptionError> {
        let animations = &hierarchy.animations;
        match self {
            Self::All => Ok(AnimationSelection::All),
            Self::None => Ok(AnimationSelection::None),
            Self::Scene(wanted) => {
                let by_index = wanted.parse().ok().filter(|index| *index < animations.len());
                let by_name =
                    || animations.iter().position(|animation| animation.name.as_ref() == Some(wanted));
                let index = by_index.or_else(by_name).ok_or_else(|| unknown_animation(wanted, hierarchy))?;
                Ok(AnimationSelection::One(index))
            }
        }
    }
}

fn unknown_animation(wanted: &str, hierarchy: &Hierarchy) -> OptionError {
    const SHOWN: usize = 8;
    let animations = &hierarchy.animations;
    let name = |(index, name): (usize, Option<&str>)| match name {
        Some(name) => format!("{index} \"{name}\""),
        None => index.to_string(),
    };
    let names = animations.iter().map(|animation| animation.name.as_deref());
    let mut list: Vec<String> = names.enumerate().take(SHOWN).map(name).collect();
    if animations.len() > SHOWN {
        list.push(format!("{} more", animations.len() - SHOWN));
    }
    let hint = match list.is_empty() {
        true => "the scene has no animations".to_owned(),
        false => format!("expected all, none, or one of: {}", list.join(", ")),
    };
    OptionError::new(OPTION, format!("unknown animation `{wanted}`; {hint}"))
}

impl FromStr for AnimationChoice {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        match text.trim() {
            "" => Err(OptionError::new(OPTION, "empty value; expected all, none, an index or a name")),
            "all" => Ok(Self::All),
            "none" => Ok(Self::None),
            _ => Ok(Self::Scene(text.to_owned())),
        }
    }
}

/// The moment of the animations that is shown, seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AnimationTime(pub f64);

impl FromStr for AnimationTime {
    type Err = OptionError;

    /// ```
    /// use shadowgraph::options::AnimationTime;
    /// assert_eq!("1.5".parse(), Ok(AnimationTime(1.5)));
    /// ```
    fn from_str(text: &str) -> Result<Self, OptionError> {
        let seconds = text.parse().ok().filter(|seconds| SECONDS.contains(*seconds));
        let reason = || format!("invalid value `{text}`; expected {SECONDS}");
        seconds.map(Self).ok_or_else(|| OptionError::new(TIME_OPTION, reason()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use shadowgraph_scene::animation::Animation;

    fn hierarchy(names: &[Option<&str>]) -> Hierarchy {
        let animation =
            |name: &Option<&str>| Animation { name: name.map(str::to_owned), channels: Vec::new() };
        Hierarchy { animations: names.iter().map(animation).collect(), ..Hierarchy::default() }
    }

    #[test]
    fn animations_are_found_by_index_and_by_name() {
        let hierarchy = hierarchy(&[Some("walk"), None, Some("0"), Some("12")]);
        let found = ["all", "none", "walk", "1", "0", "12"]
            .map(|text| text.parse::<AnimationChoice>().unwrap().resolve(&hierarchy).unwrap());
        use AnimationSelection::{All, One};
        assert_eq!(found, [All, AnimationSelection::None, One(0), One(1), One(0), One(3)]);
    }

    #[test]
    fn an_unknown_animation_is_an_error_with_the_known_ones() {
        let error = |hierarchy: &Hierarchy| {
            AnimationChoice::Scene("run".into()).resolve(hierarchy).unwrap_err().to_string()
        };
        assert_eq!(
            error(&hierarchy(&[Some("walk"), None])),
            "animation: unknown animation `run`; expected all, none, or one of: 0 \"walk\", 1"
        );
        assert!(error(&hierarchy(&[None; 10])).ends_with("7, 2 more"));
        assert!("".parse::<AnimationChoice>().is_err());
    }

    #[test]
    fn a_time_that_is_not_a_number_of_seconds_is_refused_with_the_range() {
        for text in ["", "NaN", "inf", "noon", "1e10"] {
            let error = text.parse::<AnimationTime>().unwrap_err().to_string();
            let expected =
                format!("time: invalid value `{text}`; expected -1000000000 to 1000000000 seconds");
            assert_eq!(error, expected);
        }
        assert_eq!("-2".parse(), Ok(AnimationTime(-2.0)));
    }
}
