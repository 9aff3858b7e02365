//! Settings of single techniques.

use std::any::Any;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Arc, OnceLock};

use ron::value::RawValue;
use serde::de::{DeserializeOwned, Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::{Map, Value};

use super::declare::DescribeSettings;
use super::describe::SettingType;
use crate::error::Error;

/// The settings of one technique or modifier, declared by [`declare_settings!`](crate::declare_settings). What a file leaves out has
/// its default.
pub trait NamedSettings:
    DescribeSettings + Serialize + DeserializeOwned + Default + Clone + Send + Sync + 'static
{
    /// The name of the technique or modifier.
    const NAME: &'static str;
}

/// The settings of techniques and modifiers by their names, in RON `{"pcss": (filter_taps: 32)}`.
///
/// Files are read before the types of these settings are known, so the values are kept as RON. Each is parsed and checked once, when it is
/// first read: by [`Techniques::check`](crate::Techniques::check) as files are loaded, which also finds names that no technique has. Clones
/// share what was parsed.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct TechniqueSettings(BTreeMap<String, Entry>);

impl<'de> Deserialize<'de> for TechniqueSettings {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Entries)
    }
}

/// Reads the map; a technique that is in it twice is an error.
struct Entries;

impl<'de> Visitor<'de> for Entries {
    type Value = TechniqueSettings;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a map from the names of techniques to their settings")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<TechniqueSettings, A::Error> {
        let mut entries = BTreeMap::new();
        while let Some((name, entry)) = map.next_entry::<String, Entry>()? {
            if entries.contains_key(&name) {
                return Err(A::Error::custom(format_args!("technique `{name}` has settings twice")));
            }
            entries.insert(name, entry);
        }
        Ok(TechniqueSettings(entries))
    }
}

/// The settings of one technique.
#[derive(Clone, Debug)]
struct Entry {
    text: Box<RawValue>,
    /// The settings in the type of the technique that read them first.
    parsed: OnceLock<Arc<dyn Any + Send + Sync>>,
}

impl Entry {
    fn new(text: Box<RawValue>) -> Self {
        Self { text, parsed: OnceLock::new() }
    }

    fn parse<T: NamedSettings>(&self) -> Result<T, Error> {
        if let Some(settings) = self.parsed.get().and_then(|settings| settings.downcast_ref::<T>()) {
            return Ok(settings.clone());
        }
        let settings: T = self.text.into_rust().map_err(|reason| Error::MalformedSettings {
            technique: T::NAME.to_owned(),
            reason: Box::new(reason),
        })?;
        validate(&settings)?;
        // Another thread may have been first, with the same result.
        let _kept = self.parsed.set(Arc::new(settings.clone()));
        Ok(settings)
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Serialize for Entry {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.text.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Entry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Box::<RawValue>::deserialize(deserializer).map(Self::new)
    }
}

impl TechniqueSettings {
    /// Returns a technique's settings, checked; the defaults if there are none.
    ///
    /// ```
    /// use shadowgraph_shadows::{PcssSettings, ShadowSettings};
    /// let settings: ShadowSettings = ron::from_str(r#"(techniques: {"pcss": (filter_taps: 32)})"#)?;
    /// let pcss: PcssSettings = settings.techniques.get()?;
    /// assert_eq!(pcss.filter_taps, 32);
    /// let wrong: ShadowSettings = ron::from_str(r#"(techniques: {"pcss": (taps: 32)})"#)?;
    /// let error = wrong.techniques.get::<PcssSettings>().unwrap_err().to_string();
    /// assert!(error.starts_with("settings of technique `pcss`: Unexpected field named `taps`"), "{error}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::MalformedSettings`] for a text that does not parse, [`Error::Setting`] for a value out of range.
    pub fn get<T: NamedSettings>(&self) -> Result<T, Error> {
        self.0.get(T::NAME).map_or_else(|| Ok(T::default()), Entry::parse)
    }

    /// Replaces a technique's settings.
    ///
    /// # Errors
    /// As [`get`](Self::get), and for settings that RON cannot represent.
    pub fn set<T: NamedSettings>(&mut self, settings: &T) -> Result<(), Error> {
        validate(settings)?;
        let entry = Entry::new(RawValue::from_rust(settings).map_err(|error| failed(T::NAME, &error))?);
        let _kept = entry.parsed.set(Arc::new(settings.clone()));
        self.0.insert(T::NAME.to_owned(), entry);
        Ok(())
    }

    /// Returns the names of the techniques that have settings here.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }
}

impl DescribeSettings for TechniqueSettings {
    const TYPE: SettingType = SettingType::Other(
        Some(|| Value::Object(Map::new())),
        "a map from the names of techniques to their settings",
    );

    /// Checks nothing, as the types of the settings are not known here.
    fn validate(&self) -> Result<(), Error> {
        Ok(())
    }
}

/// Checks every value; the path in an error begins with the technique.
pub(crate) fn validate<T: NamedSettings>(settings: &T) -> Result<(), Error> {
    settings.validate().map_err(|error| error.inside(T::NAME).inside("techniques"))
}

/// Returns the error that settings of a technique cannot be represented in another form.
pub(crate) fn failed(technique: &str, reason: &dyn std::fmt::Display) -> Error {
    Error::Technique { technique: technique.to_owned(), reason: format!("settings: {reason}") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::techniques::PcssSettings;

    #[test]
    fn settings_are_parsed_once_and_clones_share_them() {
        let settings: TechniqueSettings = ron::from_str(r#"{"pcss": (filter_taps: 32)}"#).unwrap();
        assert!(settings.0["pcss"].parsed.get().is_none());
        let first: PcssSettings = settings.get().unwrap();
        let kept = settings.0["pcss"].parsed.get().unwrap();
        let clone = settings.clone();
        assert!(Arc::ptr_eq(kept, clone.0["pcss"].parsed.get().unwrap()));
        assert_eq!(clone.get::<PcssSettings>().unwrap(), first);
        assert_eq!(clone, settings);
    }

    #[test]
    fn settings_that_are_set_need_no_parsing() {
        let mut settings = TechniqueSettings::default();
        let pcss = PcssSettings { filter_taps: 32, ..PcssSettings::default() };
        settings.set(&pcss).unwrap();
        assert!(settings.0["pcss"].parsed.get().is_some());
        assert_eq!(settings.get::<PcssSettings>().unwrap(), pcss);
        let changed = PcssSettings { filter_taps: 16, ..pcss };
        settings.set(&changed).unwrap();
        assert_eq!(settings.get::<PcssSettings>().unwrap(), changed);
        let error = settings.set(&PcssSettings { filter_taps: 0, ..changed }).unwrap_err().to_string();
        assert_eq!(error, "invalid value: `techniques.pcss.filter_taps` is 0; allowed: 1 to 64");
    }
}
