//! One view of one light: what is samples, what was measured, and the truth.

use glam::Vec3;

use super::MetricsError;
use super::error::check_length;

/// Only surfaces turned to the light by more than this cosine count: on others a light is as good as gone.
pub const RECEIVER_N_DOT_L: f32 = 0.05;

/// Where the light is.
#[derive(Clone, Copy, Debug)]
pub enum TowardsLight<'a> {
    /// In one direction for all pixels, unit length.
    Everywhere(Vec3),
    /// In a direction per pixel, unit length.
    PerPixel(&'a [Vec3]),
}

/// The pictures to compare, all of one size, row by row from the top.
///
/// Where nothing is drawn only `view_depths_m` is read; what is no receiver needs no visibility or truth.
#[derive(Clone, Copy, Debug)]
pub struct Images<'a> {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// The side of a pixel at a view depth of 1 m, metres: 2 tan(fov_y / 2) / height.
    pub pixel_m_at_1m: f32,
    /// Where the surface is, metres from the frame's origin, which has to be within about 1 km: rounding beyond half
    /// a pixel makes silhouettes.
    pub positions: &'a [Vec3],
    /// Which way the triangle faces, towards the camera, unit length.
    pub geometric_normals: &'a [Vec3],
    /// How far along the view axis, metres; 0 or infinite where nothing is drawn.
    pub view_depths_m: &'a [f32],
    /// The cosine between the geometric normal and the way to the light, -1 to 1.
    pub n_dot_l: &'a [f32],
    /// The share of light that arrives as a technique has it, 0 to 1.
    pub visibility: &'a [f32],
    /// The share that arrives from the light's centre, 0 or 1.
    pub truth: &'a [f32],
    /// The share that arrives from all of the light, 0 to 1, if it was traced.
    pub soft_truth: Option<&'a [f32]>,
    /// The way along the shadow ray to the nearest blocker, metres; infinite where truly lit.
    pub blocker_distances_m: &'a [f32],
    /// How many pixels a shadow texel covers there at most; 0 if unknown.
    pub texel_px: &'a [f32],
    /// The side of a shadow texel there, metres; 0 if unknown.
    pub texel_m: &'a [f32],
    /// The way to the light.
    pub towards_light: TowardsLight<'a>,
}

/// [`Images`] that fit together and hold no numbers that metrics would overlook.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    pub(super) images: Images<'a>,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl<'a> Samples<'a> {
    /// Takes the pictures.
    ///
    /// # Errors
    /// - [`MetricsError::Length`]: a picture does not have width times height pixels.
    /// - [`MetricsError::Value`]: a visibility or truth of a receiver is not from 0 to 1, a position, normal or
    ///   light direction where something is drawn is not finite, or a length or depth is NaN or negative.
    pub fn new(images: Images<'a>) -> Result<Self, MetricsError> {
        let [width, height] = images.size_px.map(|side| side as usize);
        let samples = Self { images, width, height };
        samples.check_lengths()?;
        samples.check_values()?;
        Ok(samples)
    }

    /// How many pixels there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Whether there are no pixels.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether something is drawn at a pixel below [`len`](Self::len).
    #[must_use]
    pub fn is_drawn(&self, pixel: usize) -> bool {
        let depth_m = self.images.view_depths_m[pixel];
        depth_m > 0.0 && depth_m.is_finite()
    }

    /// Whether a pixel below [`len`](Self::len) counts: something is drawn, with N·L above
    /// [`RECEIVER_N_DOT_L`].
    #[must_use]
    pub fn is_receiver(&self, pixel: usize) -> bool {
        self.is_drawn(pixel) && self.images.n_dot_l[pixel] > RECEIVER_N_DOT_L
    }

    pub(super) fn receivers(&self) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(|&pixel| self.is_receiver(pixel))
    }

    pub(super) fn is_truly_dark(&self, pixel: usize) -> bool {
        self.images.truth[pixel] < 0.5
    }

    /// Whether a pixel is measured as dark.
    pub(super) fn is_dark(&self, pixel: usize) -> bool {
        self.images.visibility[pixel] < 0.5
    }

    /// |visibility - truth|, 0 to 1.
    pub(super) fn error(&self, pixel: usize) -> f32 {
        (self.images.visibility[pixel] - self.images.truth[pixel]).abs()
    }

    pub(super) fn is_wrong(&self, pixel: usize) -> bool {
        self.error(pixel) > 0.5
    }

    pub(super) fn towards_light(&self, pixel: usize) -> Vec3 {
        match self.images.towards_light {
            TowardsLight::Everywhere(direction) => direction,
            TowardsLight::PerPixel(directions) => directions[pixel],
        }
    }

    /// The pixel `[right, down]` of another one, if it is in the picture.
    pub(super) fn beside(&self, pixel: usize, [right, down]: [isize; 2]) -> Option<usize> {
        let x = (pixel % self.width).checked_add_signed(right).filter(|&x| x < self.width)?;
        let y = (pixel / self.width).checked_add_signed(down).filter(|&y| y < self.height)?;
        Some(y * self.width + x)
    }

    fn check_lengths(&self) -> Result<(), MetricsError> {
        let images = &self.images;
        let needs = self.len();
        check_length("positions", images.positions.len(), needs)?;
        check_length("geometric_normals", images.geometric_normals.len(), needs)?;
        check_length("view_depths_m", images.view_depths_m.len(), needs)?;
        check_length("n_dot_l", images.n_dot_l.len(), needs)?;
        check_length("visibility", images.visibility.len(), needs)?;
        check_length("truth", images.truth.len(), needs)?;
        check_length("soft_truth", images.soft_truth.map_or(needs, <[f32]>::len), needs)?;
        check_length("blocker_distances_m", images.blocker_distances_m.len(), needs)?;
        check_length("texel_px", images.texel_px.len(), needs)?;
        check_length("texel_m", images.texel_m.len(), needs)?;
        match images.towards_light {
            TowardsLight::PerPixel(directions) => check_length("towards_light", directions.len(), needs),
            TowardsLight::Everywhere(_) => Ok(()),
        }
    }

    fn check_values(&self) -> Result<(), MetricsError> {
        const FINITE: &str = "finite numbers";
        const SHARE: &str = "0 to 1";
        const POSITIVE: &str = "0 and above";
        let images = &self.images;
        let side_m = images.pixel_m_at_1m;
        let distances_m = images.blocker_distances_m;
        let soft = images.soft_truth.unwrap_or(images.truth);
        let share = |values: &[f32], at: usize| (0.0..=1.0).contains(&values[at]);
        let size = |value: f32| value.is_finite() && value >= 0.0;
        let drawn = |at| self.is_drawn(at);
        let receiver = |at| self.is_receiver(at);
        let all = |_| true;
        self.check("pixel_m_at_1m", POSITIVE, all, |_| size(side_m))?;
        self.check("view_depths_m", POSITIVE, all, |at| images.view_depths_m[at] >= 0.0)?;
        self.check("positions", FINITE, drawn, |at| images.positions[at].is_finite())?;
        self.check("geometric_normals", FINITE, drawn, |at| images.geometric_normals[at].is_finite())?;
        self.check("n_dot_l", FINITE, drawn, |at| images.n_dot_l[at].is_finite())?;
        self.check("towards_light", FINITE, drawn, |at| self.towards_light(at).is_finite())?;
        self.check("texel_px", POSITIVE, drawn, |at| size(images.texel_px[at]))?;
        self.check("texel_m", POSITIVE, drawn, |at| size(images.texel_m[at]))?;
        self.check("visibility", SHARE, receiver, |at| share(images.visibility, at))?;
        self.check("truth", SHARE, receiver, |at| share(images.truth, at))?;
        self.check("soft_truth", SHARE, receiver, |at| share(soft, at))?;
        self.check("blocker_distances_m", POSITIVE, receiver, |at| distances_m[at] >= 0.0)
    }

    /// Names the first of the pixels that count whose number is no good.
    fn check(
        &self,
        list: &'static str,
        allowed: &'static str,
        counts: impl Fn(usize) -> bool,
        good: impl Fn(usize) -> bool,
    ) -> Result<(), MetricsError> {
        match (0..self.len()).position(|pixel| counts(pixel) && !good(pixel)) {
            Some(index) => Err(MetricsError::Value { list, index, allowed }),
            None => Ok(()),
        }
    }
}
