//! A technique as users choose it: with what is put on top of it.

use std::fmt;

use super::{PCF, TechniqueContext, TechniqueKind};
use crate::technique::ShadowTechnique;
use crate::techniques::{ContactSettings, ScreenSettings, ScreenShadows};
use crate::{Error, TechniqueSettings};

/// A technique, and whether its shadows are collected on the screen: `pcf`, `pcf+screen`, `pcf+contact`.
#[derive(Clone, Copy)]
pub struct Technique {
    base: TechniqueKind,
    over: Over,
}

/// What is put on top of a technique.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Over {
    #[default]
    Nothing,
    /// Its shadows are collected in a mask.
    Screen,
    /// They are collected, and short ones are added.
    Contact,
}

impl Technique {
    /// Returns its name, with what is put on top of it.
    pub fn name(&self) -> String {
        let base = self.base.name;
        match self.over {
            Over::Nothing => base.into(),
            Over::Screen => format!("{base}+{}", ScreenSettings::NAME),
            Over::Contact => format!("{base}+{}", ContactSettings::NAME),
        }
    }

    /// Returns the technique with its shadows collected in a screen mask.
    #[must_use]
    pub fn collected(self) -> Self {
        self.over_with(Over::Screen)
    }

    /// Returns the technique with its shadows collected in a screen mask, and contact shadows added.
    #[must_use]
    pub fn with_contact(self) -> Self {
        self.over_with(Over::Contact)
    }

    /// Contact shadows are collected already.
    pub(super) fn over_with(self, over: Over) -> Self {
        if self.over == Over::Contact { self } else { Self { over, ..self } }
    }

    /// Makes one.
    ///
    /// # Errors
    /// As [`TechniqueKind::make`].
    pub fn make(&self, context: &TechniqueContext<'_>) -> Result<Box<dyn ShadowTechnique>, Error> {
        let base = self.base.make(context)?;
        Ok(match self.over {
            Over::Nothing => base,
            Over::Screen => Box::new(ScreenShadows::new(context.device, base)?),
            Over::Contact => Box::new(ScreenShadows::with_contact(context.device, base)?),
        })
    }
}

impl From<TechniqueKind> for Technique {
    fn from(base: TechniqueKind) -> Self {
        Self { base, over: Over::default() }
    }
}

impl Default for Technique {
    fn default() -> Self {
        PCF.into()
    }
}

impl PartialEq for Technique {
    fn eq(&self, other: &Self) -> bool {
        (self.base.name, self.over) == (other.base.name, other.over)
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
