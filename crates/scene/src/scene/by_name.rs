//! Values by patterns of names.

use serde::de::{Deserializer, MapAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};

/// Values by patterns of names, in which `*` stands for any text and `?` for any character. Of all patterns that match a name, the last counts.
///
/// In files it is a map:
///
/// ```
/// use shadowgraph_scene::{ByName, MaterialShadows};
/// let modes: ByName<MaterialShadows> = ron::from_str(r#"{"*": (receives: true), "leaves*": (casts: Clip(0.3))}"#)?;
/// assert_eq!(modes.get("leaves of an oak").unwrap().receives, None);
/// assert_eq!(modes.get("bark").unwrap().receives, Some(true));
/// # Ok::<(), ron::error::SpannedError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ByName<T>(pub Vec<(String, T)>);

impl<T> Default for ByName<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> ByName<T> {
    /// Returns the value for a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0.iter().rev().find(|(pattern, _)| matches(pattern, name)).map(|(_, value)| value)
    }

    /// Returns the patterns that match none of the names.
    pub fn unused<'a>(
        &'a self,
        names: impl Iterator<Item = &'a str> + Clone,
    ) -> impl Iterator<Item = &'a str> {
        let patterns = self.0.iter().map(|(pattern, _)| pattern.as_str());
        patterns.filter(move |pattern| !names.clone().any(|name| matches(pattern, name)))
    }
}

/// Returns whether a pattern matches a name as a whole.
fn matches(pattern: &str, name: &str) -> bool {
    wildmatch::WildMatch::new(pattern).matches(name)
}

impl<T: Serialize> Serialize for ByName<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(pattern, value)| (pattern, value)))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for ByName<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(std::marker::PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = ByName<T>;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("a map from patterns of names")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(ByName(entries))
            }
        }

        deserializer.deserialize_map(Entries(std::marker::PhantomData))
    }
}
