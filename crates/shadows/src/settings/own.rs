//! Settings that belong to single techniques.

use std::collections::BTreeMap;

use ron::value::RawValue;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use crate::Error;

/// What a technique lets users choose. What a file leaves out has its default value.
pub trait TechniqueSettings: Serialize + DeserializeOwned + Default {
    /// The technique's name.
    const NAME: &'static str;

    /// Checks every value.
    ///
    /// # Errors
    /// [`Error::Setting`] names the first field that is out of its range, its value and the range.
    fn validate(&self) -> Result<(), Error>;
}

/// The settings of techniques by the techniques' names, in RON `{"pcss": (filter_taps: 32)}`. Each technique reads its own;
/// [`Techniques::check`](crate::Techniques::check) finds what none would read.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct OwnSettings(BTreeMap<String, Box<RawValue>>);

impl OwnSettings {
    /// Returns a technique's settings, checked; the defaults where there are none.
    ///
    /// ```
    /// use shadowgraph_shadows::{PcssSettings, ShadowSettings};
    /// let settings: ShadowSettings = ron::from_str(r#"(techniques: {"pcss": (filter_taps: 32)})"#)?;
    /// let pcss: PcssSettings = settings.techniques.get()?;
    /// assert_eq!(pcss.filter_taps, 32);
    /// let wrong: ShadowSettings = ron::from_str(r#"(techniques: {"pcss": (taps: 32)})"#)?;
    /// let error = wrong.techniques.get::<PcssSettings>().unwrap_err().to_string();
    /// assert!(error.starts_with("technique `pcss`: its settings: Unexpected field named `taps`"), "{error}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Names the technique and the field, and what it may be.
    pub fn get<T: TechniqueSettings>(&self) -> Result<T, Error> {
        let settings: T = match self.0.get(T::NAME) {
            Some(own) => own.into_rust().map_err(|reason| Error::MalformedSettings {
                technique: T::NAME.to_owned(),
                reason: Box::new(reason),
            })?,
            None => T::default(),
        };
        validate(&settings)?;
        Ok(settings)
    }

    /// Puts a technique's settings in the place of those that it has.
    ///
    /// # Errors
    /// As [`get`](Self::get), and for settings that RON cannot tell.
    pub fn set<T: TechniqueSettings>(&mut self, settings: &T) -> Result<(), Error> {
        validate(settings)?;
        let own = RawValue::from_rust(settings).map_err(|error| failed(T::NAME, &error))?;
        self.0.insert(T::NAME.to_owned(), own);
        Ok(())
    }

    /// Returns the names of the techniques that have settings here.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }
}

/// Checks every value; an error names the technique too.
fn validate<T: TechniqueSettings>(settings: &T) -> Result<(), Error> {
    settings.validate().map_err(|error| match error {
        Error::Setting { field, value, allowed } => {
            Error::TechniqueSetting { technique: T::NAME.to_owned(), field, value, allowed }
        }
        other => failed(T::NAME, &other),
    })
}

pub(crate) fn failed(technique: &str, reason: &dyn std::fmt::Display) -> Error {
    Error::Technique { technique: technique.to_owned(), reason: format!("its settings: {reason}") }
}
