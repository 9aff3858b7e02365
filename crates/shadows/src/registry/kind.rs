//! What there is to know of a technique before one is made.

use std::fmt;

use crate::rays::{GpuRayScene, RayScene};
use crate::settings::failed;
use crate::technique::ShadowTechnique;
use crate::{Error, ShadowSettings, TechniqueSettings};
use serde_json::Value;

/// A technique by name, and how one is made. A plain constant:
///
/// ```
/// use shadowgraph_shadows::{NoShadows, TechniqueKind};
/// const MINE: TechniqueKind =
///     TechniqueKind::new("mine", "everything is lit", |_context| Ok(Box::new(NoShadows)));
/// assert_eq!(MINE.name, "mine");
/// ```
#[derive(Clone, Copy)]
pub struct TechniqueKind {
    /// The name that users choose it by: small letters, digits and `_`.
    pub name: &'static str,
    /// What it is, in one line.
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

/// The settings of a technique, whatever their type.
#[derive(Clone, Copy)]
pub(super) struct SettingsKind {
    pub(super) name: &'static str,
    pub(super) check: fn(&ShadowSettings) -> Result<(), Error>,
    pub(super) defaults: fn() -> String,
    pub(super) json: fn(&ShadowSettings) -> Result<Value, Error>,
    pub(super) set_json: fn(&mut ShadowSettings, Value) -> Result<(), Error>,
}

impl SettingsKind {
    pub(super) const fn of<T: TechniqueSettings>() -> Self {
        Self {
            name: T::NAME,
            check: |settings| settings.techniques.get::<T>().map(drop),
            // Numbers and the like can always be written.
            defaults: || ron::to_string(&T::default()).unwrap_or_default(),
            json: |settings| {
                serde_json::to_value(settings.techniques.get::<T>()?).map_err(|error| failed(T::NAME, &error))
            },
            set_json: |settings, value| {
                let own: T = serde_json::from_value(value).map_err(|error| failed(T::NAME, &error))?;
                settings.techniques.set(&own)
            },
        }
    }
}

impl TechniqueKind {
    /// Describes a technique and how it is made.
    pub const fn new(name: &'static str, summary: &'static str, make: MakeTechnique) -> Self {
        Self { name, summary, make, settings: None }
    }

    /// Adds that it has settings of its own.
    #[must_use]
    pub const fn with_settings<T: TechniqueSettings>(self) -> Self {
        Self { settings: Some(SettingsKind::of::<T>()), ..self }
    }

    /// Returns the settings that it has by default, in RON; `None` if it has none of its own.
    pub fn default_settings(&self) -> Option<String> {
        self.settings.map(|settings| (settings.defaults)())
    }

    /// Makes one.
    ///
    /// # Errors
    /// If a shader does not compose, or the scene's triangles cannot be had.
    pub fn make(&self, context: &TechniqueContext<'_>) -> Result<Box<dyn ShadowTechnique>, Error> {
        (self.make)(context)
    }
}

/// What techniques are made with.
#[derive(Clone, Copy)]
pub struct TechniqueContext<'c> {
    /// The device that draws.
    pub device: &'c wgpu::Device,
    rays: Option<&'c dyn Fn() -> Result<GpuRayScene, Error>>,
}

impl<'c> TechniqueContext<'c> {
    /// For techniques of a scene without triangles.
    pub fn new(device: &'c wgpu::Device) -> Self {
        Self { device, rays: None }
    }

    /// Tells where the scene's triangles come from, for techniques that trace rays. They are relative to the origin of the
    /// frames that are drawn: when that moves, techniques are made anew.
    #[must_use]
    pub fn with_rays(self, rays: &'c dyn Fn() -> Result<GpuRayScene, Error>) -> Self {
        Self { rays: Some(rays), ..self }
    }

    /// Returns the scene's triangles.
    ///
    /// # Errors
    /// If they cannot be traced, or do not fit the device's buffers.
    pub fn rays(&self) -> Result<GpuRayScene, Error> {
        match self.rays {
            Some(rays) => rays(),
            None => Ok(GpuRayScene::new(&RayScene::new(&[], Vec::new())?, u64::MAX)?),
        }
    }
}
