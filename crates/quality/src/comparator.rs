//! One light in one view: what a technique says, the truth, and how they differ.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use shadowgraph_scene::{Camera, Light, LightKind, Projection};
use shadowgraph_shadows::rays::RayScene;
use shadowgraph_shadows::{ShadowInputs, plan_shadows};

use super::fine::Fine;
use super::ground_truth::RayLight;
use super::metrics::{
    Band, EdgeError, Images, MeanError, Misclassified, MissingContacts, PeterPanning, RECEIVER_N_DOT_L,
    Samples, TowardsLight, band, edge_error, mean_error, misclassified, missing_contacts, peter_panning,
};
use super::{GroundTruth, SurfaceReader, Surfaces, Texels, ViewImages};
use shadowgraph::{Gpu, Renderer, ViewOptions, ray_scene};

use crate::Error;

/// Half of the angle that the sun takes up in the sky, radians.
pub const SUN_ANGULAR_RADIUS: f32 = 0.004_65;

/// The radius of spot and point lights, metres: files say nothing of it.
pub const PUNCTUAL_LIGHT_RADIUS_M: f32 = 0.05;

/// What a visibility of 8 bits can be off by.
const NUMERIC_NOISE: f32 = 1.0 / 255.0;

/// How a technique's shadows of one light differ from the truth in one view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewErrors {
    /// Pixels on the wrong side of one half.
    pub misclassified: Misclassified,
    /// How far visibility is off on average.
    pub mean_error: MeanError,
    /// Shadow that is missing where things touch.
    #[serde(rename = "lost_contacts")]
    pub missing_contacts: MissingContacts,
    /// How far shadows begin from what casts them.
    #[serde(rename = "detachment")]
    pub peter_panning: PeterPanning,
}

/// What is known of a light in a view before any technique is asked.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// What the view sees.
    pub surfaces: Surfaces,
    /// The light.
    pub light: RayLight,
    /// Whether the light's centre is samples.
    pub truth: GroundTruth,
    /// How much of the light is samples, 0 to 1, if that was asked for.
    pub soft: Option<Vec<f32>>,
    /// The texels of the shadow maps that the settings ask for. They decide how wide the band is, for every technique:
    /// all are judged by the same pixels.
    pub texels: Texels,
}

/// A technique's errors in a view.
#[derive(Clone, Debug)]
pub struct Compared {
    /// How its shadows differ from hard truth.
    pub errors: ViewErrors,
    /// How its edges differ from soft truth, if that is known.
    pub edges: Option<EdgeError>,
    /// What was looked at.
    pub pictures: ViewImages,
}

/// Measures views of one scene.
pub struct Comparator<'g> {
    gpu: &'g Gpu,
    reader: SurfaceReader,
    light: usize,
    /// The triangles, relative to this origin.
    rays: Option<(DVec3, RayScene)>,
}

impl<'g> Comparator<'g> {
    /// Prepares to measure `light` in views of renderers of one scene, whose pictures show that light's visibility.
    ///
    /// # Errors
    /// A failure of the GPU.
    pub fn new(gpu: &'g Gpu, renderer: &Renderer, light: usize) -> Result<Self, Error> {
        Ok(Self { gpu, reader: SurfaceReader::new(gpu, renderer)?, light, rays: None })
    }

    /// Measures a view, without soft truth.
    ///
    /// # Errors
    /// Settings out of range, a picture over the adapter's limits, or a failure of the GPU.
    pub fn measure(&mut self, renderer: &mut Renderer, options: &ViewOptions) -> Result<Compared, Error> {
        let reference = self.reference(renderer, options, 0)?;
        self.compare(renderer, options, &reference)
    }

    /// Finds the truth of a view. Soft truth is found by `soft_rays` rays a pixel; 0: not at all.
    ///
    /// # Errors
    /// As [`measure`](Self::measure).
    pub fn reference(
        &mut self,
        renderer: &mut Renderer,
        options: &ViewOptions,
        soft_rays: u32,
    ) -> Result<Reference, Error> {
        let surfaces = self.reader.read(self.gpu, renderer, options)?;
        let origin_world = renderer.casters().scene.origin_world();
        let eye = (options.camera.position_world() - origin_world).as_vec3();
        let source = &renderer.scene().lights[self.light];
        let light = RayLight::new(source, light_size(source), origin_world);
        let rays = self.rays(renderer, origin_world)?;
        let truth = GroundTruth::trace(rays, &surfaces, &light, eye);
        let soft = (soft_rays > 0)
            .then(|| GroundTruth::trace_soft(rays, &surfaces, &light, eye, &truth.hard, soft_rays));
        let texels = texels(renderer, options, &surfaces, self.light, origin_world)?;
        Ok(Reference { surfaces, light, truth, soft, texels })
    }

    /// Draws what a renderer's technique says of a view, and compares it with the truth.
    ///
    /// # Errors
    /// As [`measure`](Self::measure).
    pub fn compare(
        &self,
        renderer: &mut Renderer,
        options: &ViewOptions,
        reference: &Reference,
    ) -> Result<Compared, Error> {
        let drawn = renderer.draw(self.gpu, options)?;
        let Reference { surfaces, truth, soft, texels, .. } = reference;
        let mut n_dot_l = truth.n_dot_l.clone();
        let visibility = visibility(&drawn.image.rgba8, &mut n_dot_l);
        let samples = Samples::new(Images {
            size_px: options.size_px,
            pixel_m_at_1m: pixel_m_at_1m(&options.camera, options.size_px[1]),
            positions: &surfaces.positions,
            geometric_normals: &surfaces.normals,
            view_depths_m: &surfaces.view_depths_m,
            n_dot_l: &n_dot_l,
            visibility: &visibility,
            truth: &truth.hard,
            soft_truth: soft.as_deref(),
            blocker_distances_m: &truth.blocker_distances_m,
            texel_px: &texels.reach_px,
            texel_m: &texels.side_m,
            towards_light: TowardsLight::PerPixel(&truth.towards_light),
        })?;
        let mut band = band(&samples);
        self.widen(&mut band, &visibility, options, reference, &n_dot_l);
        let errors = ViewErrors {
            misclassified: misclassified(&samples, &band),
            mean_error: mean_error(&samples, &band),
            missing_contacts: missing_contacts(&samples),
            peter_panning: peter_panning(&samples),
        };
        let edges = edge_error(&samples);
        let receivers = (0..samples.len()).map(|pixel| samples.is_receiver(pixel)).collect();
        let truth = truth.hard.clone();
        let pictures = ViewImages { size_px: options.size_px, receivers, band, visibility, truth };
        Ok(Compared { errors, edges, pictures })
    }

    /// Adds pixels that differ from the truth to the band if an edge runs past their centres, in a shadow that is
    /// narrower than pixels are apart.
    fn widen(
        &self,
        band: &mut Band,
        visibility: &[f32],
        options: &ViewOptions,
        reference: &Reference,
        n_dot_l: &[f32],
    ) {
        let Some((origin_world, rays)) = &self.rays else { return };
        let fine = Fine::new(rays, &reference.light, &reference.surfaces, options, *origin_world);
        for pixel in 0..visibility.len() {
            let differs = (visibility[pixel] - reference.truth.hard[pixel]).abs() > NUMERIC_NOISE;
            let counts = reference.surfaces.is_drawn(pixel) && n_dot_l[pixel] > RECEIVER_N_DOT_L;
            if differs && counts && !band.contains(pixel) && fine.changes_around(pixel) {
                band.insert(pixel);
            }
        }
    }

    /// The triangles relative to an origin.
    fn rays(&mut self, renderer: &Renderer, origin_world: DVec3) -> Result<&RayScene, Error> {
        let kept = self.rays.take().filter(|(origin, _)| *origin == origin_world);
        let rays = match kept {
            Some((_, rays)) => rays,
            None => ray_scene(renderer.scene(), origin_world)?,
        };
        Ok(&self.rays.insert((origin_world, rays)).1)
    }
}

/// How large a light is for soft truth: the sun's radius in radians, else that of a lamp in metres.
fn light_size(light: &Light) -> f32 {
    match light.kind {
        LightKind::Directional { .. } => SUN_ANGULAR_RADIUS,
        LightKind::Spot { .. } | LightKind::Point { .. } => PUNCTUAL_LIGHT_RADIUS_M,
    }
}

/// The grey of a picture of visibilities. Where a surface faces away by its shading normal it is not drawn, and does
/// not count.
fn visibility(rgba8: &[u8], n_dot_l: &mut [f32]) -> Vec<f32> {
    let texels = rgba8.chunks_exact(4).zip(n_dot_l);
    texels
        .map(|(texel, n_dot_l)| {
            if texel[3] == 0 {
                *n_dot_l = n_dot_l.min(0.0);
            }
            f32::from(texel[0]) / 255.0
        })
        .collect()
}

/// The texels of the maps that a view's settings ask for.
pub(super) fn texels(
    renderer: &Renderer,
    options: &ViewOptions,
    surfaces: &Surfaces,
    light: usize,
    origin_world: DVec3,
) -> Result<Texels, Error> {
    let plan = plan_shadows(&ShadowInputs {
        view: 0,
        camera: &options.camera,
        aspect: options.aspect(),
        lights: &renderer.scene().lights,
        casters: renderer.casters(),
        origin_world,
        settings: &options.shadows,
    })?;
    Ok(Texels::new(surfaces, &plan, light, options, origin_world))
}

/// The side of a pixel at a view depth of 1 m; of an orthographic camera, at every depth.
pub(super) fn pixel_m_at_1m(camera: &Camera, height_px: u32) -> f32 {
    let height_m = match camera.projection {
        Projection::Perspective { fov_y, .. } => 2.0 * (fov_y * 0.5).tan(),
        Projection::Orthographic { half_height, .. } => 2.0 * half_height,
    };
    (height_m / f64::from(height_px)) as f32
}
