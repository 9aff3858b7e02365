//! A technique with its modifier.

use std::fmt;

use super::{PCF, TechniqueContext, TechniqueKind};
use crate::error::Error;
use crate::settings::NamedSettings;
use crate::technique::ShadowTechnique;
use crate::techniques::{ContactSettings, ScreenSettings, ScreenShadows};

/// A technique and its modifier: `pcf`, `pcf+screen`, `pcf+contact`.
#[derive(Clone, Copy)]
pub struct Technique {
    base: TechniqueKind,
    modifier: Modifier,
}

/// A change to how a technique's shadows are evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Modifier {
    #[default]
    None,
    /// Shadows are evaluated in screen space, into a mask.
    Screen,
    /// `Screen` with contact shadows.
    Contact,
}

impl Technique {
    /// Returns the name with the modifier, such as `pcf+contact`.
    pub fn name(&self) -> String {
        let base = self.base.name;
        match self.modifier {
            Modifier::None => base.into(),
            Modifier::Screen => format!("{base}+{}", ScreenSettings::NAME),
            Modifier::Contact => format!("{base}+{}", ContactSettings::NAME),
        }
    }

    /// Returns the technique with its shadows evaluated in screen space.
    #[must_use]
    pub fn with_screen(self) -> Self {
        self.with_modifier(Modifier::Screen)
    }

    /// Returns the technique with its shadows evaluated in screen space, and contact shadows added.
    #[must_use]
    pub fn with_contact(self) -> Self {
        self.with_modifier(Modifier::Contact)
    }

    /// Returns the technique with a modifier; `Contact` includes `Screen`.
    pub(super) fn with_modifier(self, modifier: Modifier) -> Self {
        if self.modifier == Modifier::Contact { self } else { Self { modifier, ..self } }
    }

    /// Creates an instance of the technique.
    ///
    /// # Errors
    /// As [`TechniqueKind::make`].
    pub fn make(&self, context: &TechniqueContext<'_>) -> Result<Box<dyn ShadowTechnique>, Error> {
        let base = self.base.make(context)?;
        Ok(match self.modifier {
            Modifier::None => base,
            Modifier::Screen => Box::new(ScreenShadows::new(context.device, base)?),
            Modifier::Contact => Box::new(ScreenShadows::with_contact(context.device, base)?),
        })
    }
}

impl From<TechniqueKind> for Technique {
    fn from(base: TechniqueKind) -> Self {
        Self { base, modifier: Modifier::default() }
    }
}

impl Default for Technique {
    fn default() -> Self {
        PCF.into()
    }
}

impl PartialEq for Technique {
    fn eq(&self, other: &Self) -> bool {
        (self.base.name, self.modifier) == (other.base.name, other.modifier)
    }
}

impl Eq for Technique {}

impl PartialEq<TechniqueKind> for Technique {
    fn eq(&self, other: &TechniqueKind) -> bool {
        *self == Self::from(*other)
    }
}

impl fmt::Debug for Technique {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Technique({})", self.name())
    }
}
