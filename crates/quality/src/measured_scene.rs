//! A scene with the lights and views that are measured.

use std::path::Path;

use shadowgraph_samples::test_scenes;
use shadowgraph_scene::{Camera, Light, LightKind, Scene, gltf};

use super::views::automatic_views;
use super::{Case, SceneSource};
use crate::Error;

/// Maximum number of lights of a file that are measured.
pub const MAX_LIGHTS: usize = 4;

/// Number of views that are chosen automatically for a scene without views.
pub const DEFAULT_VIEWS: usize = 4;

/// A scene to measure.
#[derive(Clone, Debug)]
pub struct MeasuredScene {
    /// Name in tables.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// The lights to measure, one after the other.
    pub lights: Vec<MeasuredLight>,
    /// The cameras, with their names.
    pub views: Vec<(String, Camera)>,
}

/// A light that is measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredLight {
    /// Name in tables.
    pub name: String,
    /// All lights of the scene while this one is measured.
    pub all: Vec<Light>,
    /// Index of the measured light among them.
    pub index: usize,
}

impl MeasuredScene {
    /// Creates the measured scene with the scene's own lights: the first [`MAX_LIGHTS`] that cast shadows. If `views` is
    /// empty, views are chosen automatically.
    ///
    /// # Errors
    /// If the scene's triangles cannot be traced, which choosing views requires.
    pub fn new(name: impl Into<String>, scene: Scene, views: Vec<(String, Camera)>) -> Result<Self, Error> {
        let casting = scene.lights().iter().enumerate().filter(|(_, light)| light.casts_shadow);
        let light = |(index, light): (usize, &Light)| MeasuredLight {
            name: format!("{} {index}", kind(light)),
            all: scene.lights().to_vec(),
            index,
        };
        let lights = casting.take(MAX_LIGHTS).map(light).collect();
        Self { name: name.into(), scene, lights, views }.with_default_views(DEFAULT_VIEWS)
    }

    /// Chooses `count` views if there are none.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    fn with_default_views(mut self, count: usize) -> Result<Self, Error> {
        if self.views.is_empty() {
            self.views = automatic_views(&self.scene, count)?;
        }
        Ok(self)
    }

    /// Loads the scene of a case. Relative paths start at `folder`. If neither the case has suns nor the
    /// file lights, a default sun is added.
    ///
    /// # Errors
    /// If the file cannot be loaded.
    pub fn from_case(case: &Case, folder: &Path) -> Result<Self, Error> {
        let mut scene = match &case.scene {
            SceneSource::TestScene(name) => test_scenes::test_scene(name).unwrap_or_default(),
            SceneSource::File(file) => gltf::load(&folder.join(file))?,
        };
        if scene.lights().is_empty() && case.sun_elevations_deg.is_empty() {
            scene.insert_light(shadowgraph::options::default_sun());
        }
        let mut views: Vec<_> = case.views.iter().map(|view| (view.name.clone(), view.camera())).collect();
        if views.is_empty() {
            let named = |(index, camera): (usize, &Camera)| {
                (camera.name.clone().unwrap_or_else(|| format!("camera {index}")), camera.clone())
            };
            views = scene.cameras.iter().enumerate().map(named).collect();
        }
        let mut measured_scene = Self::new(case.name(), scene, views)?;
        if !case.sun_elevations_deg.is_empty() {
            measured_scene.lights = case
                .sun_elevations_deg
                .iter()
                .map(|&elevation| measured_scene.sun(case, elevation))
                .collect();
        }
        Ok(measured_scene)
    }

    /// Returns the sun of a case, which replaces the scene's own.
    fn sun(&self, case: &Case, elevation_deg: f64) -> MeasuredLight {
        let is_directional = |light: &&Light| matches!(light.kind, LightKind::Directional { .. });
        let others = self.scene.lights().iter().filter(|light| !is_directional(light)).cloned();
        let all = std::iter::once(case.sun(elevation_deg)).chain(others).collect();
        MeasuredLight { name: format!("sun {elevation_deg}°"), all, index: 0 }
    }
}

fn kind(light: &Light) -> &'static str {
    match light.kind {
        LightKind::Directional { .. } => "sun",
        LightKind::Spot { .. } => "spot",
        LightKind::Point { .. } => "point",
    }
}
