//! Compares the shadows of one light in one view with ground truth.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use shadowgraph_scene::{Camera, Light, LightKind, Projection};
use shadowgraph_shadows::{ShadowInputs, plan_shadows};

use super::ground_truth::RayLight;
use super::metrics::{
    Band, EdgeError, Images, MeanError, Misclassified, MissingContacts, PeterPanning, RECEIVER_N_DOT_L,
    Samples, TowardsLight, band, edge_error, mean_error, misclassified, missing_contacts, percentile,
    peter_panning,
};
use super::scene_truth::SceneTruth;
use super::subpixel::SubpixelReference;
use super::{GroundTruth, SurfaceReader, Surfaces, Texels, ViewImages};
use shadowgraph::{Gpu, Renderer, ViewOptions};

use crate::Error;

/// Angular radius of the sun, radians.
pub const SUN_ANGULAR_RADIUS: f32 = 0.004_65;

/// Radius of spot and point lights, metres, which files do not contain.
pub const PUNCTUAL_LIGHT_RADIUS_M: f32 = 0.05;

/// Rounding error of a visibility of 8 bits.
const NUMERIC_NOISE: f32 = 1.0 / 255.0;

/// Errors of a technique's shadows of one light in one view.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ViewErrors {
    /// Misclassified pixels.
    pub misclassified: Misclassified,
    /// Mean error of visibility.
    pub mean_error: MeanError,
    /// Missing contact shadows.
    #[serde(rename = "lost_contacts")]
    pub missing_contacts: MissingContacts,
    /// Peter-panning: distance between contacts and the beginning of shadows.
    #[serde(rename = "detachment")]
    pub peter_panning: PeterPanning,
}

/// The reference of a light in a view, independent of the technique.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// The visible surfaces.
    pub surfaces: Surfaces,
    /// The light.
    pub light: RayLight,
    /// Hard reference: visibility of the light's centre.
    pub truth: GroundTruth,
    /// Soft reference: visible fraction of the light, 0 to 1, if requested.
    pub soft: Option<Vec<f32>>,
    /// The texels of the shadow maps according to the settings. They determine the width of the band, so all
    /// techniques are measured on the same pixels.
    pub texels: Texels,
}

impl Reference {
    /// Returns whether a pixel counts: it has geometry that faces the light.
    pub(super) fn is_receiver(&self, pixel: usize) -> bool {
        self.surfaces.is_drawn(pixel) && self.truth.n_dot_l[pixel] > RECEIVER_N_DOT_L
    }

    /// Returns the values of the pixels that count.
    pub(super) fn receiver_values(&self, values: &[f32]) -> Vec<f32> {
        (0..values.len()).filter(|&pixel| self.is_receiver(pixel)).map(|pixel| values[pixel]).collect()
    }

    /// Returns the median view depth of the pixels that count, metres; `None` if there are none.
    pub(super) fn median_depth_m(&self) -> Option<f64> {
        percentile(&self.receiver_values(&self.surfaces.view_depths_m), 50.0).map(f64::from)
    }
}

/// A technique's errors in a view.
#[derive(Clone, Debug)]
pub struct ViewComparison {
    /// Errors against the hard reference.
    pub errors: ViewErrors,
    /// Errors of edges against the soft reference, if there is one.
    pub edges: Option<EdgeError>,
    /// The compared images.
    pub images: ViewImages,
}

/// Measures views of one scene.
pub struct Comparator<'g> {
    gpu: &'g Gpu,
    reader: SurfaceReader,
    light: usize,
    sun_radius_rad: f32,
    /// The triangles.
    truth: SceneTruth,
}

impl<'g> Comparator<'g> {
    /// Prepares to measure `light` in views of renderers of one scene, whose output is the visibility of that light.
    ///
    /// # Errors
    /// A failure of the GPU.
    pub fn new(gpu: &'g Gpu, renderer: &Renderer, light: usize) -> Result<Self, Error> {
        let (reader, sun_radius_rad) = (SurfaceReader::new(gpu, renderer)?, SUN_ANGULAR_RADIUS);
        Ok(Self { gpu, reader, light, sun_radius_rad, truth: SceneTruth::default() })
    }

    /// Sets the angular radius of directional lights in the soft reference, radians; the default is the sun's.
    #[must_use]
    pub fn with_sun_radius(self, sun_radius_rad: f32) -> Self {
        Self { sun_radius_rad, ..self }
    }

    /// Measures a view, without a soft reference.
    ///
    /// # Errors
    /// Settings out of range, an image over the adapter's limits, or a failure of the GPU.
    pub fn measure(
        &mut self,
        renderer: &mut Renderer,
        options: &ViewOptions,
    ) -> Result<ViewComparison, Error> {
        let reference = self.reference(renderer, options, 0)?;
        self.compare(renderer, options, &reference)
    }

    /// Computes the reference of a view. The soft reference takes `soft_rays` rays per pixel; with 0 there is none.
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
        let source = &renderer.scene().lights()[self.light];
        let light = RayLight::new(source, light_size(source, self.sun_radius_rad), origin_world);
        let rays = self.truth.follow(renderer.scene(), origin_world)?;
        let truth = GroundTruth::trace(rays, &surfaces, &light, eye);
        let soft = (soft_rays > 0)
            .then(|| GroundTruth::trace_soft(rays, &surfaces, &light, eye, &truth.hard, soft_rays));
        let texels = texels(renderer, options, &surfaces, self.light, origin_world)?;
        Ok(Reference { surfaces, light, truth, soft, texels })
    }

    /// Renders a view with the renderer's technique, and compares it with the reference.
    ///
    /// # Errors
    /// As [`measure`](Self::measure).
    pub fn compare(
        &self,
        renderer: &mut Renderer,
        options: &ViewOptions,
        reference: &Reference,
    ) -> Result<ViewComparison, Error> {
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
            texel_px: &texels.extent_px,
            texel_m: &texels.side_m,
            towards_light: TowardsLight::PerPixel(&truth.towards_light),
        })?;
        let mut band = band(&samples);
        self.widen_band(&mut band, &visibility, options, reference, &n_dot_l);
        let errors = ViewErrors {
            misclassified: misclassified(&samples, &band),
            mean_error: mean_error(&samples, &band),
            missing_contacts: missing_contacts(&samples),
            peter_panning: peter_panning(&samples),
        };
        let edges = edge_error(&samples);
        let receivers = (0..samples.len()).map(|pixel| samples.is_receiver(pixel)).collect();
        let truth = truth.hard.clone();
        let images = ViewImages { size_px: options.size_px, receivers, band, visibility, truth };
        Ok(ViewComparison { errors, edges, images })
    }

    /// Adds pixels that differ from the reference to the band if there is an edge near their centres, as of a shadow
    /// that is narrower than the distance of pixels.
    fn widen_band(
        &self,
        band: &mut Band,
        visibility: &[f32],
        options: &ViewOptions,
        reference: &Reference,
        n_dot_l: &[f32],
    ) {
        let Some(rays) = self.truth.rays() else { return };
        let fine = SubpixelReference::new(rays, &reference.light, &reference.surfaces, options);
        for pixel in 0..visibility.len() {
            let differs = (visibility[pixel] - reference.truth.hard[pixel]).abs() > NUMERIC_NOISE;
            let counts = reference.surfaces.is_drawn(pixel) && n_dot_l[pixel] > RECEIVER_N_DOT_L;
            if differs && counts && !band.contains(pixel) && fine.changes_around(pixel) {
                band.insert(pixel);
            }
        }
    }
}

/// Returns the size of a light for the soft reference: angular radius of the sun in radians, else radius in metres.
fn light_size(light: &Light, sun_radius_rad: f32) -> f32 {
    match light.kind {
        LightKind::Directional { .. } => sun_radius_rad,
        LightKind::Spot { .. } | LightKind::Point { .. } => PUNCTUAL_LIGHT_RADIUS_M,
    }
}

/// Returns the grey values of a visibility image. Where the shading normal faces away nothing is drawn, and the pixel
/// does not count.
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

/// Computes the texels of the maps according to a view's settings.
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
        lights: renderer.scene().lights(),
        casters: renderer.casters(),
        origin_world,
        settings: &options.shadows,
    })?;
    Ok(Texels::new(surfaces, &plan, light, options, origin_world))
}

/// Returns the size of a pixel at a view depth of 1 m, or at any depth for an orthographic camera.
pub(super) fn pixel_m_at_1m(camera: &Camera, height_px: u32) -> f32 {
    let height_m = match camera.projection {
        Projection::Perspective { fov_y, .. } => 2.0 * (fov_y * 0.5).tan(),
        Projection::Orthographic { half_height, .. } => 2.0 * half_height,
    };
    (height_m / f64::from(height_px)) as f32
}
