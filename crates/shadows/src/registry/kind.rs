//! Techniques by name, before one is created.

use std::fmt;

use crate::error::Error;
use crate::settings::{NamedSettings, Setting, SettingType, ShadowSettings, failed, json, validate};
use crate::technique::ShadowTechnique;
use serde_json::Value;

/// A technique by name, and the function that creates one. A plain constant:
///
/// ```
/// use shadowgraph_shadows::{NoShadows, TechniqueKind};
/// const MINE: TechniqueKind =
///     TechniqueKind::new("mine", "everything is lit", |_context| Ok(Box::new(NoShadows)));
/// assert_eq!(MINE.name, "mine");
/// ```
#[derive(Clone, Copy)]
pub struct TechniqueKind {
    /// The name that users choose: lower-case letters, digits and `_`.
    pub name: &'static str,
    /// One line about the technique.
    pub summary: &'static str,
    pub(super) make: MakeTechnique,
    pub(super) settings: Option<SettingsKind>,
}

impl fmt::Debug for TechniqueKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "TechniqueKind({})", self.name)
    }
}

type MakeTechnique = fn(&TechniqueContext<'_>) -> Result<Box<dyn ShadowTechnique>, Error>;

/// The settings of a technique or modifier, without their type.
#[derive(Clone, Copy)]
pub(super) struct SettingsKind {
    pub(super) name: &'static str,
    pub(super) settings: fn() -> &'static [Setting],
    pub(super) check_defaults: fn() -> Result<(), Error>,
    pub(super) check: fn(&ShadowSettings) -> Result<(), Error>,
    pub(super) json: fn(&ShadowSettings) -> Result<Value, Error>,
    pub(super) set_json: fn(&mut ShadowSettings, Value) -> Result<(), Error>,
}

impl SettingsKind {
    pub(super) const fn new<T: NamedSettings>() -> Self {
        Self {
            name: T::NAME,
            settings: T::settings,
            check_defaults: || validate(&T::default()),
            check: |settings| settings.techniques.get::<T>().map(drop),
            json: |settings| Ok(json(&settings.techniques.get::<T>()?)),
            set_json: |settings, value| {
                let read: T = serde_json::from_value(value).map_err(|error| failed(T::NAME, &error))?;
                settings.techniques.set(&read)
            },
        }
    }

    /// Returns the defaults as RON.
    pub(super) fn defaults(&self) -> String {
        let ty = SettingType::Struct((self.settings)());
        ty.ron(&ty.default_value())
    }
}

impl TechniqueKind {
    /// Describes a technique and the function that creates one.
    pub const fn new(name: &'static str, summary: &'static str, make: MakeTechnique) -> Self {
        Self { name, summary, make, settings: None }
    }

    /// Adds the technique's settings.
    #[must_use]
    pub const fn with_settings<T: NamedSettings>(self) -> Self {
        Self { settings: Some(SettingsKind::new::<T>()), ..self }
    }

    /// Returns the descriptions of the technique's settings; empty if it has none.
    pub fn settings(&self) -> &'static [Setting] {
        self.settings.map_or(&[], |settings| (settings.settings)())
    }

    /// Returns the defaults of the technique's settings in RON; `None` if it has no settings.
    pub fn default_settings(&self) -> Option<String> {
        self.settings.map(|settings| settings.defaults())
    }

    /// Creates an instance of the technique.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn make(&self, context: &TechniqueContext<'_>) -> Result<Box<dyn ShadowTechnique>, Error> {
        (self.make)(context)
    }
}

/// The device that techniques are created for.
#[derive(Clone, Copy)]
pub struct TechniqueContext<'c> {
    /// The device that draws.
    pub device: &'c wgpu::Device,
}

impl<'c> TechniqueContext<'c> {
    /// Creates a context.
    pub fn new(device: &'c wgpu::Device) -> Self {
        Self { device }
    }
}
