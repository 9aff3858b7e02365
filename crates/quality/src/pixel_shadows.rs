//! The shadows of each light at one pixel: what the technique shows there, and what a ray says.

mod remedies;
mod text;
mod traced;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

use glam::DVec3;
use serde::Serialize;
use shadowgraph::options::Aov;
use shadowgraph::{ExplainedShadow, Gpu, RenderConfig, Renderer, ShadowExplainer, ViewOptions};
use shadowgraph_scene::{Light, LightKind, Scene};
use shadowgraph_shadows::{RAYTRACED, ShadowFact, Unshadowed, VIRTUAL};

use super::scene_truth::SceneTruth;
use super::{SurfaceReader, Surfaces};
use traced::Traced;

use crate::Error;

/// A technique's visibility differs from that of a ray if it is off by more than this.
const DIFFERENCE: f32 = 0.5;

/// The shadows at a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelShadows {
    /// The technique.
    pub technique: String,
    /// The visible opaque surface; none where the background is.
    pub surface: Option<PixelSurface>,
    /// The lights of the scene; none where the background is.
    pub lights: Vec<PixelLight>,
}

/// The surface at a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelSurface {
    /// Position, metres.
    pub position_world: [f64; 3],
    /// Geometric normal, towards the camera.
    pub normal: [f32; 3],
    /// Distance from the plane of the camera, metres.
    pub view_depth_m: f32,
    /// Name of the instance, if it casts shadows.
    pub instance: Option<String>,
}

/// A light at a pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelLight {
    /// Index in the scene.
    pub light: u32,
    /// Name; empty if it has none.
    pub name: String,
    /// `directional`, `spot` or `point`.
    pub kind: &'static str,
    /// Whether its light can reach the surface.
    pub reach: Reachability,
    /// Why it casts no shadow in this frame, if it does not.
    pub unshadowed: Option<String>,
    /// Red, green and blue of the image `visibility:N` at the pixel, 0 to 255, if light can reach the surface.
    pub visibility: Option<[u8; 3]>,
    /// The visibility that the technique computes at the surface, without what it computes in screen space, red, green and blue, 0 to 1;
    /// `None` for a technique without an explanation.
    pub visibility_at_point: Option<[f32; 3]>,
    /// Where the technique reads it from: its map, depths and biases.
    pub facts: Vec<ShadowFact>,
    /// The transmittance of a ray to the centre of the light, red, green and blue, 0 to 1, if light can reach the surface.
    pub ray: Option<[f32; 3]>,
    /// The nearest opaque surface along that ray.
    pub blocker: Option<PixelBlocker>,
    /// Whether rays from points within a pixel of its centre differ: the pixel is at the edge of a shadow, where a filter differs from one ray.
    /// Only known where the technique differs from the ray by more than one half.
    pub is_at_edge: bool,
    /// If the technique differs from the ray by more than one half: a change of a setting that lowers the difference.
    pub remedy: Option<PixelRemedy>,
}

/// A change of a setting.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelRemedy {
    /// The setting as in a settings file, such as `(cascades: (count: 4))`, or the technique.
    pub setting: String,
    /// The visibility with it, 0 to 255.
    pub visibility: [u8; 3],
}

/// Whether a light can reach a surface, were it not for blockers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reachability {
    /// It can.
    Reached,
    /// The surface faces away.
    FacesAway,
    /// The surface is outside of the light's range or cone.
    Outside,
}

/// What blocks a light.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PixelBlocker {
    /// Name of the instance.
    pub instance: String,
    /// Distance from the surface, metres.
    pub distance_m: f32,
}

impl PixelLight {
    /// Returns the difference between the technique's visibility and that of the ray, means of the channels, 0 to 1.
    #[must_use]
    pub fn error(&self) -> Option<f32> {
        let shown = self.visibility?.iter().map(|&byte| f32::from(byte)).sum::<f32>() / 765.0;
        let truth = self.ray?.iter().sum::<f32>() / 3.0;
        Some((shown - truth).abs())
    }

    /// Returns whether they differ by more than one half.
    #[must_use]
    pub fn differs(&self) -> bool {
        self.error().is_some_and(|error| error > DIFFERENCE)
    }
}

/// Explains the shadows at pixels of a view of a scene.
pub struct ShadowInspector<'i> {
    gpu: &'i Gpu,
    scene: &'i Scene,
    options: &'i ViewOptions,
    config: &'i RenderConfig,
    origin_world: DVec3,
    surfaces: Surfaces,
    truth: SceneTruth,
    unshadowed: Vec<Unshadowed>,
    /// The image `visibility:N` of each light N that a pixel has needed, and its renderer.
    visible: BTreeMap<u32, (Renderer, Vec<u8>)>,
    explainer: Option<(Renderer, ShadowExplainer)>,
}

impl<'i> ShadowInspector<'i> {
    /// Draws the surfaces of a view. Shadows will be those of a renderer with `config`.
    ///
    /// # Errors
    /// Settings out of range, an image over the adapter's limits, or a failure of the GPU.
    pub fn new(
        gpu: &'i Gpu,
        scene: &'i Scene,
        options: &'i ViewOptions,
        config: &'i RenderConfig,
    ) -> Result<Self, Error> {
        let aov = if scene.lights().is_empty() { Aov::Color } else { Aov::Visibility(0) };
        let mut renderer = Renderer::with_config(gpu, scene.clone(), &options.camera, aov, config.clone())?;
        let surfaces = SurfaceReader::new(gpu, &renderer)?.read(gpu, &mut renderer, options)?;
        let origin_world = renderer.casters().scene.origin_world();
        let (_, unshadowed) = renderer.plan(options)?;
        let mut truth = SceneTruth::default();
        truth.follow(scene, origin_world)?;
        let explainer = ShadowExplainer::new(gpu, &renderer)?.map(|explainer| (renderer, explainer));
        Ok(Self {
            gpu,
            scene,
            options,
            config,
            origin_world,
            surfaces,
            truth,
            unshadowed,
            visible: BTreeMap::new(),
            explainer,
        })
    }

    /// Returns the shadows at a pixel, column and row from the top left. The first pixel that a light reaches draws its visibility.
    ///
    /// # Errors
    /// For a pixel outside of the image, and for a failure of the GPU.
    pub fn shadows_at(&mut self, pixel: [u32; 2]) -> Result<PixelShadows, Error> {
        let index = self.options.pixel_index(pixel)?;
        let technique = self.config.technique().name();
        if !self.surfaces.is_drawn(index) {
            return Ok(PixelShadows { technique, surface: None, lights: Vec::new() });
        }
        let lights = (0u32..).zip(self.scene.lights()).map(|(number, light)| {
            let mut found = self.traced(index).light(number, light);
            found.unshadowed = self.unshadowed(number, light);
            if found.reach == Reachability::Reached {
                let (_, image) = self.visibility(number)?;
                // The normal of the lit pass is more precise than that of surfaces.
                if is_facing_away(image, index) {
                    (found.reach, found.ray, found.blocker) = (Reachability::FacesAway, None, None);
                } else {
                    found.visibility = rgb(image, index);
                }
            }
            if found.differs() && found.unshadowed.is_none() {
                found.is_at_edge = self.traced(index).is_at_edge(light);
                found.remedy = self.remedy(index, &found)?;
            }
            Ok(found)
        });
        let mut lights = lights.collect::<Result<Vec<_>, Error>>()?;
        self.explain(index, &mut lights)?;
        Ok(PixelShadows { technique, surface: Some(self.traced(index).surface()), lights })
    }

    /// Adds what the technique says about the lights that reach a pixel.
    fn explain(&mut self, index: usize, lights: &mut [PixelLight]) -> Result<(), Error> {
        let reached = || lights.iter().filter(|light| light.reach == Reachability::Reached);
        let points: Vec<_> = reached().map(|light| self.traced(index).point(light.light)).collect();
        let Some((renderer, explainer)) = &mut self.explainer else { return Ok(()) };
        let explained = explainer.explain(self.gpu, renderer, self.options, &points)?;
        let reached = lights.iter_mut().filter(|light| light.reach == Reachability::Reached);
        for (light, ExplainedShadow { visibility, facts }) in reached.zip(explained) {
            (light.visibility_at_point, light.facts) = (Some(visibility.to_array()), facts);
        }
        Ok(())
    }

    fn traced(&self, index: usize) -> Traced<'_> {
        let Self { truth, surfaces, options, origin_world, .. } = self;
        Traced { truth, surfaces, options, origin_world: *origin_world, index }
    }

    /// Returns why a light casts no shadow in the frame.
    fn unshadowed(&self, number: u32, light: &Light) -> Option<String> {
        if !light.casts_shadow {
            return Some("it casts none".into());
        }
        let missing = self.unshadowed.iter().find(|unshadowed| unshadowed.light == number);
        missing.map(|missing| missing.reason.describe().to_string())
    }

    /// Returns the renderer of a light's visibility, and the image.
    fn visibility(&mut self, light: u32) -> Result<&mut (Renderer, Vec<u8>), Error> {
        Ok(match self.visible.entry(light) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(missing) => {
                let Self { gpu, scene, options, config, .. } = *self;
                let aov = Aov::Visibility(light);
                let mut renderer =
                    Renderer::with_config(gpu, scene.clone(), &options.camera, aov, config.clone())?;
                let image = renderer.draw(gpu, options)?.image.rgba8;
                missing.insert((renderer, image))
            }
        })
    }

    /// Returns the change of a setting, or the technique, with which the visibility is nearest to that of a ray, if it is nearer than without.
    fn remedy(&mut self, index: usize, light: &PixelLight) -> Result<Option<PixelRemedy>, Error> {
        let Self { gpu, scene, options, config, .. } = *self;
        let is_directional =
            matches!(scene.lights()[light.light as usize].kind, LightKind::Directional { .. });
        let (renderer, _) = self.visibility(light.light)?;
        let mut best = Best { light, found: None };
        for (setting, shadows) in remedies::changes(&options.shadows, is_directional) {
            let changed = ViewOptions { shadows, ..options.clone() };
            // A larger map may exceed a limit of the device.
            if let Ok(drawn) = renderer.draw(gpu, &changed) {
                best.consider(setting, rgb(&drawn.image.rgba8, index));
            }
        }
        for kind in [VIRTUAL, RAYTRACED] {
            if best.found.is_some() {
                break;
            }
            let config = RenderConfig { technique: Some(kind.into()), ..config.clone() };
            let aov = Aov::Visibility(light.light);
            let drawn = Renderer::with_config(gpu, scene.clone(), &options.camera, aov, config)
                .and_then(|mut renderer| renderer.draw(gpu, options));
            // `raytraced` needs buffers that a device may not have.
            if let Ok(drawn) = drawn {
                best.consider(format!("technique: {}", kind.name), rgb(&drawn.image.rgba8, index));
            }
        }
        Ok(best.found)
    }
}

/// The best change so far.
struct Best<'l> {
    light: &'l PixelLight,
    found: Option<PixelRemedy>,
}

impl Best<'_> {
    fn consider(&mut self, setting: String, visibility: Option<[u8; 3]>) {
        let Some(visibility) = visibility else { return };
        let error = |rgb| PixelLight { visibility: Some(rgb), ..self.light.clone() }.error().unwrap_or(1.0);
        let least = self.found.as_ref().map(|found| found.visibility).or(self.light.visibility);
        if least.is_none_or(|least| error(visibility) < error(least)) {
            self.found = Some(PixelRemedy { setting, visibility });
        }
    }
}

/// Returns whether the image `visibility:N` says that the surface at a pixel faces away from the light.
fn is_facing_away(rgba8: &[u8], index: usize) -> bool {
    rgba8.chunks_exact(4).nth(index).is_some_and(|rgba| rgba[3] == 0)
}

fn rgb(rgba8: &[u8], index: usize) -> Option<[u8; 3]> {
    rgba8.chunks_exact(4).nth(index).map(|rgba| [rgba[0], rgba[1], rgba[2]])
}
