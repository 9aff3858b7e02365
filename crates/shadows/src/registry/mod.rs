//! The techniques by name.

mod built_in;
mod check;
mod choice;
mod kind;

pub use built_in::{EVSM, MSM, NONE, PCF, PCSS, RAYTRACED, SDSM};
pub use choice::Technique;
pub use kind::{TechniqueContext, TechniqueKind};

use choice::Over;
use kind::SettingsKind;

use crate::techniques::{ContactSettings, ScreenSettings};
use crate::{Error, ShadowSettings};
use serde_json::Value;

/// The techniques that there are.
///
/// ```
/// use shadowgraph_shadows::{PCF, Techniques};
/// let techniques = Techniques::built_in();
/// assert_eq!(techniques.find("pcf")?, PCF);
/// assert_eq!(techniques.find("pcss+contact")?.name(), "pcss+contact");
/// let error = techniques.find("soft").unwrap_err().to_string();
/// assert!(error.starts_with("there is no technique `soft`; there is: pcf, pcss,"));
/// # Ok::<(), shadowgraph_shadows::Error>(())
/// ```
#[derive(Clone)]
pub struct Techniques {
    kinds: Vec<TechniqueKind>,
}

/// Something that goes on top of a technique.
struct Top {
    summary: &'static str,
    over: Over,
    settings: SettingsKind,
}

/// What can be put on top of a technique, with `+` between. They are called as their settings.
const TOPS: [Top; 2] = [
    Top {
        summary: "shadows collected in a screen mask before anything is lit, blurred if asked",
        over: Over::Screen,
        settings: SettingsKind::of::<ScreenSettings>(),
    },
    Top {
        summary: "collected, and short shadows added of what the picture shows",
        over: Over::Contact,
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
        let is_taken = self.kinds.iter().map(|known| known.name).chain(TOPS.map(|top| top.settings.name));
        check::name(kind.name, is_taken)
            .and_then(|()| check::kind(&kind))
            .map_err(|fault| Error::Technique { technique: kind.name.to_owned(), fault })?;
        self.kinds.push(kind);
        Ok(())
    }

    /// Returns them, the default first.
    pub fn kinds(&self) -> &[TechniqueKind] {
        &self.kinds
    }

    /// Returns what can be put on top of each, with `+` between: names, what they are, and the settings that they have by
    /// default.
    pub fn combinations() -> impl Iterator<Item = (&'static str, &'static str, String)> {
        TOPS.into_iter().map(|top| (top.settings.name, top.summary, (top.settings.defaults)()))
    }

    /// Returns the technique of a name, such as `pcf` or `pcf+contact`. What goes on top of others goes on top of the default
    /// one where it stands alone.
    ///
    /// # Errors
    /// [`Error::NoTechnique`] with a name that is like it, or all.
    pub fn find(&self, name: &str) -> Result<Technique, Error> {
        let over = |part: &str| TOPS.iter().find(|top| top.settings.name == part).map(|top| top.over);
        let base = |part: &str| self.kinds.iter().find(|kind| kind.name == part).copied();
        let mut found = None;
        for (place, part) in name.split('+').map(str::trim).enumerate() {
            found = match (base(part), over(part)) {
                (Some(kind), _) if place == 0 => Some(Technique::from(kind)),
                (_, Some(over)) => Some(found.unwrap_or_default().over_with(over)),
                _ if place > 0 => return Err(self.unknown(&format!("+{part}"))),
                _ => return Err(self.unknown(part)),
            };
        }
        found.ok_or_else(|| self.unknown(name))
    }

    fn unknown(&self, name: &str) -> Error {
        let names: Vec<_> = self.kinds.iter().map(|kind| kind.name.to_owned()).collect();
        let overs = TOPS.map(|top| format!("+{}", top.settings.name));
        let of_place = if name.starts_with('+') { &overs[..] } else { &names[..] };
        let near: Vec<_> = of_place.iter().filter(|known| strsim::osa_distance(known, name) == 1).collect();
        let hint = match near[..] {
            [near] => format!("; did you mean `{near}`?"),
            _ => format!("; there is: {}; each also with {}", names.join(", "), overs.join(" or ")),
        };
        Error::NoTechnique { name: name.into(), hint }
    }

    /// Returns the names of all that has settings of its own: techniques, and what can be put on top of them.
    pub fn with_settings(&self) -> impl Iterator<Item = &'static str> {
        self.settings_kinds().map(|settings| settings.name)
    }

    /// Returns the settings of a technique, or of what is put on top, as JSON with every field; `None` if it has none.
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
                fault: "it has no settings of its own".into(),
            }),
        }
    }

    fn settings_kinds(&self) -> impl Iterator<Item = SettingsKind> {
        let of_kinds = self.kinds.iter().filter_map(|kind| kind.settings);
        of_kinds.chain(TOPS.map(|top| top.settings))
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
                    let fault = "it has no settings of its own".into();
                    Err(Error::Technique { technique: name.into(), fault })
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
