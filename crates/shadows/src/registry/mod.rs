//! Registered techniques and their modifiers, by name.

mod built_in;
mod check;
mod choice;
mod kind;

pub use built_in::{EVSM, MSM, NONE, PCF, PCSS, RAYTRACED, SDSM, VIRTUAL};
pub use choice::Technique;
pub use kind::{TechniqueContext, TechniqueKind};

use choice::Modifier;
use kind::SettingsKind;

use crate::error::Error;
use crate::settings::fields_schema;
use crate::settings::{Setting, ShadowSettings};
use crate::techniques::{ContactSettings, ScreenSettings};
use serde_json::{Value, json};
use shadowgraph_core::closest_name;

/// The registered techniques.
///
/// ```
/// use shadowgraph_shadows::{PCF, Techniques};
/// let techniques = Techniques::built_in();
/// assert_eq!(techniques.find("pcf")?, PCF);
/// assert_eq!(techniques.find("pcss+contact")?.name(), "pcss+contact");
/// let error = techniques.find("soft").unwrap_err().to_string();
/// assert!(error.starts_with("unknown technique `soft`; expected one of: pcf, pcss,"));
/// # Ok::<(), shadowgraph_shadows::Error>(())
/// ```
#[derive(Clone)]
pub struct Techniques {
    kinds: Vec<TechniqueKind>,
}

/// A modifier by name.
#[derive(Clone, Copy)]
struct ModifierKind {
    summary: &'static str,
    modifier: Modifier,
    settings: SettingsKind,
}

/// The modifiers, which follow a technique's name after `+`. Their names are those of their settings.
const MODIFIERS: [ModifierKind; 2] = [
    ModifierKind {
        summary: "shadows in screen space: computed in a mask before lighting, optionally blurred",
        modifier: Modifier::Screen,
        settings: SettingsKind::new::<ScreenSettings>(),
    },
    ModifierKind {
        summary: "shadows in screen space, and short contact shadows by ray marching in the depth buffer",
        modifier: Modifier::Contact,
        settings: SettingsKind::new::<ContactSettings>(),
    },
];

/// A modifier of techniques, such as `contact` in `pcf+contact`.
#[derive(Clone, Copy, Debug)]
pub struct TechniqueModifier {
    /// The name.
    pub name: &'static str,
    /// One line about the modifier.
    pub summary: &'static str,
    /// Descriptions of its settings.
    pub settings: &'static [Setting],
}

impl Techniques {
    /// Returns the built-in techniques.
    #[must_use]
    pub fn built_in() -> Self {
        Self { kinds: built_in::ALL.into() }
    }

    /// Adds a technique after checking its name and settings, that its shaders compose, that their bindings and structs
    /// match what it declares, and that it leaves enough bindings for the rest of a lit pass on every device. In browsers only the name is checked.
    ///
    /// # Errors
    /// [`Error::Technique`] names the technique and what is wrong with it.
    pub fn register(&mut self, kind: TechniqueKind) -> Result<(), Error> {
        let is_taken =
            self.kinds.iter().map(|known| known.name).chain(MODIFIERS.map(|kind| kind.settings.name));
        check::name(kind.name, is_taken)
            .and_then(|()| check::kind(&kind))
            .map_err(|reason| Error::Technique { technique: kind.name.to_owned(), reason })?;
        self.kinds.push(kind);
        Ok(())
    }

    /// Returns the techniques, the default first.
    pub fn kinds(&self) -> &[TechniqueKind] {
        &self.kinds
    }

    /// Returns the modifiers, which follow a technique's name after `+`.
    pub fn modifiers() -> impl Iterator<Item = TechniqueModifier> {
        MODIFIERS.into_iter().map(|kind| TechniqueModifier {
            name: kind.settings.name,
            summary: kind.summary,
            settings: (kind.settings.settings)(),
        })
    }

    /// Returns the technique of a name, such as `pcf` or `pcf+contact`. A modifier alone is applied to the default technique.
    ///
    /// # Errors
    /// [`Error::UnknownTechnique`] lists the known names, and a similar one if there is one.
    pub fn find(&self, name: &str) -> Result<Technique, Error> {
        let modifier =
            |part: &str| MODIFIERS.iter().find(|kind| kind.settings.name == part).map(|kind| kind.modifier);
        let base = |part: &str| self.kinds.iter().find(|kind| kind.name == part).copied();
        let mut found = None;
        for (place, part) in name.split('+').map(str::trim).enumerate() {
            found = match (base(part), modifier(part)) {
                (Some(kind), _) if place == 0 => Some(Technique::from(kind)),
                (_, Some(modifier)) => Some(found.unwrap_or_default().with_modifier(modifier)),
                _ if place > 0 => return Err(self.unknown(&format!("+{part}"))),
                _ => return Err(self.unknown(part)),
            };
        }
        found.ok_or_else(|| self.unknown(name))
    }

    fn unknown(&self, name: &str) -> Error {
        let names: Vec<_> = self.kinds.iter().map(|kind| kind.name.to_owned()).collect();
        let modifiers = MODIFIERS.map(|kind| format!("+{}", kind.settings.name));
        let candidates = if name.starts_with('+') { &modifiers[..] } else { &names[..] };
        let near = closest_name(name, candidates);
        let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let (names, modifiers) = (names.join(", "), modifiers.join(" or "));
        let hint = format!("; {near}expected one of: {names}; each also with {modifiers}");
        Error::UnknownTechnique { name: name.into(), hint }
    }

    /// Returns the names of all techniques and modifiers that have settings.
    pub fn with_settings(&self) -> impl Iterator<Item = &'static str> {
        self.settings_kinds().map(|kind| kind.name)
    }

    /// Returns the descriptions of the settings of a technique or modifier; empty if it has none.
    ///
    /// ```
    /// let techniques = shadowgraph_shadows::Techniques::built_in();
    /// let settings = techniques.describe_settings("pcss");
    /// let taps = settings.iter().find(|setting| setting.name == "filter_taps").ok_or("pcss has it")?;
    /// assert_eq!((taps.default_ron(), taps.allowed()), ("24".into(), "1 to 64".into()));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn describe_settings(&self, name: &str) -> &'static [Setting] {
        let kind = self.settings_kinds().find(|kind| kind.name == name);
        kind.map_or(&[], |kind| (kind.settings)())
    }

    /// Returns the JSON Schema of settings files, with the settings of all techniques and modifiers.
    pub fn settings_schema(&self) -> Value {
        let mut schema = fields_schema(ShadowSettings::SETTINGS);
        let techniques =
            self.settings_kinds().map(|kind| (kind.name.to_owned(), fields_schema((kind.settings)())));
        schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
        schema["title"] = "Shadow settings of Shadowgraph".into();
        schema["properties"]["techniques"] = json!({
            "type": "object",
            "properties": techniques.collect::<serde_json::Map<_, _>>(),
            "additionalProperties": false,
        });
        schema
    }

    /// Returns the settings of a technique or modifier as JSON with every field; `None` if it has none.
    ///
    /// ```
    /// use shadowgraph_shadows::{ShadowSettings, Techniques};
    /// let (techniques, mut settings) = (Techniques::built_in(), ShadowSettings::default());
    /// let mut pcss = techniques.technique_settings("pcss", &settings).ok_or("pcss has settings")??;
    /// pcss["filter_taps"] = 32.into();
    /// techniques.set_technique_settings("pcss", &mut settings, pcss.clone())?;
    /// pcss["filter_taps"] = 0.into();
    /// let error = techniques.set_technique_settings("pcss", &mut settings, pcss).unwrap_err().to_string();
    /// assert!(error.contains("1 to 64"), "{error}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn technique_settings(&self, name: &str, settings: &ShadowSettings) -> Option<Result<Value, Error>> {
        let known = self.settings_kinds().find(|known| known.name == name)?;
        Some((known.json)(settings))
    }

    /// Replaces the settings of a technique or modifier by JSON as [`technique_settings`](Self::technique_settings) returns it.
    ///
    /// # Errors
    /// For an unknown field or a value out of range; nothing is changed then.
    pub fn set_technique_settings(
        &self,
        name: &str,
        settings: &mut ShadowSettings,
        value: Value,
    ) -> Result<(), Error> {
        match self.settings_kinds().find(|known| known.name == name) {
            Some(known) => (known.set_json)(settings, value),
            None => Err(no_settings(name)),
        }
    }

    fn settings_kinds(&self) -> impl Iterator<Item = SettingsKind> {
        let of_kinds = self.kinds.iter().filter_map(|kind| kind.settings);
        of_kinds.chain(MODIFIERS.map(|kind| kind.settings))
    }

    /// Checks all settings, including those of single techniques, which are parsed here once.
    ///
    /// # Errors
    /// As [`ShadowSettings::validate`]; [`Error::UnknownTechnique`] for settings of an unknown technique.
    pub fn check(&self, settings: &ShadowSettings) -> Result<(), Error> {
        settings.validate()?;
        settings.techniques.names().try_for_each(|name| {
            match self.settings_kinds().find(|known| known.name == name) {
                Some(known) => (known.check)(settings),
                None => {
                    self.find(name)?;
                    Err(no_settings(name))
                }
            }
        })
    }
}

fn no_settings(name: &str) -> Error {
    Error::Technique { technique: name.into(), reason: "it has no settings".into() }
}

impl Default for Techniques {
    fn default() -> Self {
        Self::built_in()
    }
}

#[cfg(test)]
mod tests;
