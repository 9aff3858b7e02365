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
    /// [`Error::NoTechnique`] with the names there are.
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
        let names: Vec<_> = self.kinds.iter().map(|kind| kind.name).collect();
        let overs = TOPS.map(|top| format!("+{}", top.settings.name)).join(" or ");
        Error::NoTechnique {
            name: name.into(),
            known: format!("{}; each also with {overs}", names.join(", ")),
        }
    }

    /// Checks all settings, those of single techniques too.
    ///
    /// # Errors
    /// As [`ShadowSettings::validate`]; for settings of techniques that there are not.
    pub fn check(&self, settings: &ShadowSettings) -> Result<(), Error> {
        settings.validate()?;
        settings.techniques.names().try_for_each(|name| {
            let of_kinds = self.kinds.iter().filter_map(|kind| kind.settings);
            let mut known = of_kinds.chain(TOPS.map(|top| top.settings));
            match known.find(|known| known.name == name) {
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
