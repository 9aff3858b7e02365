//! The techniques by name.

mod built_in;
mod check;
mod choice;
mod kind;

pub use built_in::{EVSM, MSM, NONE, PCF, PCSS, RAYTRACED, SDSM};
pub use choice::Technique;
pub use kind::{TechniqueContext, TechniqueKind};

use choice::Modifier;
use kind::SettingsKind;

use crate::techniques::{ContactSettings, ScreenSettings};
use crate::{Error, ShadowSettings};
use serde_json::Value;
use shadowgraph_core::closest_name;

/// The techniques that there are.
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

/// What is known of a modifier.
struct ModifierKind {
    summary: &'static str,
    modifier: Modifier,
    settings: SettingsKind,
}

/// The modifiers of techniques, written `technique+modifier`. Their names are those of their settings.
const MODIFIERS: [ModifierKind; 2] = [
    ModifierKind {
        summary: "shadows collected in a screen mask before anything is lit, blurred if asked",
        modifier: Modifier::Screen,
        settings: SettingsKind::of::<ScreenSettings>(),
    },
    ModifierKind {
        summary: "collected, and short shadows added of what the picture shows",
        modifier: Modifier::Contact,
        settings: SettingsKind::of::<ContactSettings>(),
    },
];

impl Techniques {
    /// Returns those that come with Shadowgraph.
    #[must_use]
    pub fn built_in() -> Self {
        Self { kinds: built_in::ALL.into() }
    }

    /// Adds a technique, after it was checked: its name, its settings, that its shaders compose and their bindings and structs
    /// are what it says they are, and that it leaves room for the rest of a lit pass on every device.
    ///
    /// # Errors
    /// [`Error::Technique`] names the technique and what is wrong with it.
    pub fn register(&mut self, kind: TechniqueKind) -> Result<(), Error> {
        let is_taken =
            self.kinds.iter().map(|known| known.name).chain(MODIFIERS.map(|known| known.settings.name));
        check::name(kind.name, is_taken)
            .and_then(|()| check::kind(&kind))
            .map_err(|reason| Error::Technique { technique: kind.name.to_owned(), reason })?;
        self.kinds.push(kind);
        Ok(())
    }

    /// Returns them, the default first.
    pub fn kinds(&self) -> &[TechniqueKind] {
        &self.kinds
    }

    /// Returns the modifiers that can follow the name of a technique after a `+`: names, summaries and default settings.
    pub fn modifiers() -> impl Iterator<Item = (&'static str, &'static str, String)> {
        MODIFIERS.into_iter().map(|known| (known.settings.name, known.summary, (known.settings.defaults)()))
    }

    /// Returns the technique of a name, such as `pcf` or `pcf+contact`. A modifier alone applies to the default technique.
    ///
    /// # Errors
    /// [`Error::UnknownTechnique`] lists the known names, and a similar one if there is one.
    pub fn find(&self, name: &str) -> Result<Technique, Error> {
        let modifier = |part: &str| {
            MODIFIERS.iter().find(|known| known.settings.name == part).map(|known| known.modifier)
        };
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
        let modifiers = MODIFIERS.map(|known| format!("+{}", known.settings.name));
        let of_place = if name.starts_with('+') { &modifiers[..] } else { &names[..] };
        let near = closest_name(name, of_place);
        let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let (names, modifiers) = (names.join(", "), modifiers.join(" or "));
        let hint = format!("; {near}expected one of: {names}; each also with {modifiers}");
        Error::UnknownTechnique { name: name.into(), hint }
    }

    /// Returns the names of the techniques and modifiers that have settings of their own.
    pub fn with_settings(&self) -> impl Iterator<Item = &'static str> {
        self.settings_kinds().map(|settings| settings.name)
    }

    /// Returns the settings of a technique or modifier as JSON with every field; `None` if it has none.
    ///
    /// ```
    /// use shadowgraph_shadows::{ShadowSettings, Techniques};
    /// let (techniques, mut settings) = (Techniques::built_in(), ShadowSettings::default());
    /// let mut pcss = techniques.own_settings("pcss", &settings).ok_or("pcss has settings")??;
    /// pcss["filter_taps"] = 32.into();
    /// techniques.set_own_settings("pcss", &mut settings, pcss.clone())?;
    /// pcss["filter_taps"] = 0.into();
    /// let error = techniques.set_own_settings("pcss", &mut settings, pcss).unwrap_err().to_string();
    /// assert!(error.contains("1 to 64"), "{error}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn own_settings(&self, name: &str, settings: &ShadowSettings) -> Option<Result<Value, Error>> {
        let known = self.settings_kinds().find(|known| known.name == name)?;
        Some((known.json)(settings))
    }

    /// Puts settings in the place of those that a technique has, as [`own_settings`](Self::own_settings) gives them.
    ///
    /// # Errors
    /// A field that it does not have, or a value out of range: nothing is changed then.
    pub fn set_own_settings(
        &self,
        name: &str,
        settings: &mut ShadowSettings,
        value: Value,
    ) -> Result<(), Error> {
        match self.settings_kinds().find(|known| known.name == name) {
            Some(known) => (known.set_json)(settings, value),
            None => Err(Error::Technique {
                technique: name.into(),
                reason: "it has no settings of its own".into(),
            }),
        }
    }

    fn settings_kinds(&self) -> impl Iterator<Item = SettingsKind> {
        let of_kinds = self.kinds.iter().filter_map(|kind| kind.settings);
        of_kinds.chain(MODIFIERS.map(|known| known.settings))
    }

    /// Checks all settings, those of single techniques too.
    ///
    /// # Errors
    /// As [`ShadowSettings::validate`]; for settings of techniques that there are not.
    pub fn check(&self, settings: &ShadowSettings) -> Result<(), Error> {
        settings.validate()?;
        settings.techniques.names().try_for_each(|name| {
            match self.settings_kinds().find(|known| known.name == name) {
                Some(known) => (known.check)(settings),
                None => {
                    self.find(name)?;
                    let reason = "it has no settings of its own".into();
                    Err(Error::Technique { technique: name.into(), reason })
                }
            }
        })
    }
}

impl Default for Techniques {
    fn default() -> Self {
        Self::built_in()
    }
}

#[cfg(test)]
mod tests;
