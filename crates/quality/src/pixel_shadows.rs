//! The shadows of each light at one pixel: what the technique shows there, and what a ray says.

mod remedies;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fmt::Write as _;

use glam::{DVec3, Vec3};
use serde::Serialize;
use shadowgraph::inspect::lights::kind;
use shadowgraph::options::Aov;
use shadowgraph::{Gpu, RenderConfig, Renderer, ViewOptions};
use shadowgraph_scene::{Light, LightKind, Scene};
use shadowgraph_shadows::rays::{LightShape, Ray, RayScene, ReceiverPoint, trace_hard};
use shadowgraph_shadows::{RAYTRACED, Unshadowed, VIRTUAL};

use super::ground_truth::{RayLight, receiver};
use super::scene_truth::SceneTruth;
use super::subpixel::SubpixelReference;
use super::{SurfaceReader, Surfaces};

use crate::Error;

/// A technique's visibility differs from that of a ray if it is off by more than this.
const DIFFERENCE: f32 = 0.5;

/// Distances that are the same up to this factor are those of one surface.
const SAME_SURFACE: f32 = 1e-3;

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
    /// The setting and its value.
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
        let mut renderer =
            Renderer::with_config(gpu, scene.clone(), &options.camera, Aov::Color, config.clone())?;
        let surfaces = SurfaceReader::new(gpu, &renderer)?.read(gpu, &mut renderer, options)?;
        let origin_world = renderer.casters().scene.origin_world();
        let (_, unshadowed) = renderer.plan(options)?;
        let mut truth = SceneTruth::default();
        truth.follow(scene, origin_world)?;
        let visible = BTreeMap::new();
        Ok(Self { gpu, scene, options, config, origin_world, surfaces, truth, unshadowed, visible })
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
                found.visibility = rgb(image, index);
            }
            if found.differs() && found.unshadowed.is_none() {
                found.is_at_edge = self.traced(index).is_at_edge(light);
                found.remedy = self.remedy(index, &found)?;
            }
            Ok(found)
        });
        let lights = lights.collect::<Result<_, Error>>()?;
        Ok(PixelShadows { technique, surface: Some(self.traced(index).surface()), lights })
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

fn rgb(rgba8: &[u8], index: usize) -> Option<[u8; 3]> {
    rgba8.chunks_exact(4).nth(index).map(|rgba| [rgba[0], rgba[1], rgba[2]])
}

/// What rays from a pixel's surface depend on.
struct Traced<'t> {
    truth: &'t SceneTruth,
    surfaces: &'t Surfaces,
    options: &'t ViewOptions,
    origin_world: DVec3,
    index: usize,
}

impl Traced<'_> {
    fn eye(&self) -> Vec3 {
        (self.options.camera.position_world() - self.origin_world).as_vec3()
    }

    fn surface(&self) -> PixelSurface {
        let position = self.surfaces.positions[self.index];
        PixelSurface {
            position_world: (position.as_dvec3() + self.origin_world).to_array(),
            normal: self.surfaces.normals[self.index].to_array(),
            view_depth_m: self.surfaces.view_depths_m[self.index],
            instance: self.seen(position),
        }
    }

    /// Returns the name of the instance that the camera sees.
    fn seen(&self, position: Vec3) -> Option<String> {
        let (direction, distance_m) = (position - self.eye()).normalize_and_length();
        let ray = Ray::new(self.eye(), direction, 0.0, f32::INFINITY);
        let hit = self.truth.rays()?.nearest_hit(&ray)?;
        let is_seen = (hit.distance_m - distance_m).abs() <= SAME_SURFACE * distance_m;
        if is_seen { self.truth.name(hit.instance) } else { None }
    }

    fn light(&self, number: u32, light: &Light) -> PixelLight {
        let source = RayLight::new(light, 0.0, self.origin_world);
        let mut found = PixelLight {
            light: number,
            name: light.name.clone().unwrap_or_default(),
            kind: kind(light),
            reach: Reachability::Outside,
            unshadowed: None,
            visibility: None,
            ray: None,
            blocker: None,
            is_at_edge: false,
            remedy: None,
        };
        let receiver = receiver(self.surfaces, self.index, self.eye());
        let Some(rays) = self.truth.rays() else { return found };
        if source.direction_from(receiver.position).is_none() {
            return found;
        }
        let hard = trace_hard(rays, &source.shape, &receiver, true);
        if hard.faces_away {
            return PixelLight { reach: Reachability::FacesAway, ..found };
        }
        found.reach = Reachability::Reached;
        found.ray = Some(hard.visibility.to_array());
        found.blocker = self.blocker(rays, &source.shape, &receiver);
        found
    }

    fn is_at_edge(&self, light: &Light) -> bool {
        let source = RayLight::new(light, 0.0, self.origin_world);
        let Some(rays) = self.truth.rays() else { return false };
        SubpixelReference::new(rays, &source, self.surfaces, self.options).changes_around(self.index)
    }

    fn blocker(&self, rays: &RayScene, light: &LightShape, receiver: &ReceiverPoint) -> Option<PixelBlocker> {
        let hit = rays.nearest_hit(&light.ray(rays, receiver, glam::Vec2::ZERO)?)?;
        Some(PixelBlocker { instance: self.truth.name(hit.instance)?, distance_m: hit.distance_m })
    }
}

impl PixelShadows {
    /// Returns the shadows as text, a line for each light.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = format!("shadows of `{}`\n", self.technique);
        let Some(surface) = &self.surface else {
            text.push_str("  no surface: the background\n");
            return text;
        };
        let PixelSurface { position_world: [x, y, z], normal: [a, b, c], view_depth_m, instance } = surface;
        let named = instance.as_ref().map_or_else(String::new, |name| format!(" of `{name}`"));
        let _ = writeln!(
            text,
            "  surface{named} at {x:.3} {y:.3} {z:.3}, normal {a:.3} {b:.3} {c:.3}, {view_depth_m:.3} m in front of the camera"
        );
        for light in &self.lights {
            let name = if light.name.is_empty() { String::new() } else { format!(" `{}`", light.name) };
            let _ = writeln!(text, "  light {}{name} ({}): {}", light.light, light.kind, described(light));
        }
        text
    }
}

fn described(light: &PixelLight) -> String {
    match light.reach {
        Reachability::FacesAway => return "dark: the surface faces away".into(),
        Reachability::Outside => return "dark: outside of its range or cone".into(),
        Reachability::Reached => {}
    }
    let visibility = light.visibility.map(|rgb| format!("visibility {}, ", shown(rgb))).unwrap_or_default();
    let truth = match (&light.blocker, light.ray) {
        (Some(PixelBlocker { instance, distance_m }), _) => {
            format!("blocked by `{instance}`, {distance_m:.3} m away")
        }
        (None, Some(rgb)) if rgb != [1.0; 3] => format!("{} passes translucent surfaces", channels(rgb)),
        (None, _) => "nothing blocks".into(),
    };
    let unshadowed = light.unshadowed.as_ref().map_or_else(String::new, |why| format!("; no shadows: {why}"));
    let place = if light.is_at_edge {
        "at an edge, where the technique differs"
    } else {
        "the technique is wrong here"
    };
    let differs = match &light.remedy {
        Some(PixelRemedy { setting, visibility }) => {
            format!("; {place}: `{setting}` gives {}", shown(*visibility))
        }
        None if light.differs() => format!("; {place}, and no setting that was tried helps"),
        None => String::new(),
    };
    format!("{visibility}{truth}{differs}{unshadowed}")
}

fn shown(visibility: [u8; 3]) -> String {
    channels(visibility.map(|byte| f32::from(byte) / 255.0))
}

/// Writes equal channels once.
fn channels(rgb: [f32; 3]) -> String {
    match rgb {
        [r, g, b] if r == g && g == b => format!("{r:.3}"),
        [r, g, b] => format!("{r:.3} {g:.3} {b:.3}"),
    }
}
