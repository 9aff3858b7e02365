//! A technique as users choose it, with its modifier.

use std::fmt;

use super::{PCF, TechniqueContext, TechniqueKind};
use crate::technique::ShadowTechnique;
use crate::techniques::{ContactSettings, ScreenSettings, ScreenShadows};
use crate::{Error, TechniqueSettings};

/// A technique, and whether its shadows are collected on the screen: `pcf`, `pcf+screen`, `pcf+contact`.
#[derive(Clone, Copy)]
pub struct Technique {
    base: TechniqueKind,
    modifier: Modifier,
}

/// What is added to a technique.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Modifier {
    #[default]
    None,
    /// Its shadows are collected in a mask.
    Screen,
    /// Its shadows are collected in a mask, and contact shadows are added.
    Contact,
}

impl Technique {
    /// Returns its name, with the modifier.
    pub fn name(&self) -> String {
        let base = self.base.name;
        match self.modifier {
            Modifier::None => base.into(),
            Modifier::Screen => format!("{base}+{}", ScreenSettings::NAME),
            Modifier::Contact => format!("{base}+{}", ContactSettings::NAME),
        }
    }

    /// Returns the technique with its shadows collected in a screen mask.
    #[must_use]
    pub fn collected(self) -> Self {
        self.with_modifier(Modifier::Screen)
    }

    /// Returns the technique with its shadows collected in a screen mask, and contact shadows added.
    #[must_use]
    pub fn with_contact(self) -> Self {
        self.with_modifier(Modifier::Contact)
    }

    /// Returns the technique with a modifier. Contact shadows include the screen mask.
    pub(super) fn with_modifier(self, modifier: Modifier) -> Self {
        if self.modifier == Modifier::Contact { self } else { Self { modifier, ..self } }
    }

    /// Makes one.
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
