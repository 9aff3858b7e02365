//! The samples of one view and light: surfaces, measured visibility and reference.

use glam::Vec3;

/// Minimum N·L of receivers: surfaces at a more grazing angle receive hardly any light and do not count.
pub const RECEIVER_N_DOT_L: f32 = 0.05;

/// Direction towards the light.
#[derive(Clone, Copy, Debug)]
pub enum TowardsLight<'a> {
    /// The same direction for all pixels, unit length.
    Uniform(Vec3),
    /// One direction per pixel, unit length.
    PerPixel(&'a [Vec3]),
}

/// Images to compare, all of the same size, row by row from the top.
///
/// Only `view_depths_m` is read of pixels without geometry; visibility and truth are read at receivers only.
#[derive(Clone, Copy, Debug)]
pub struct Images<'a> {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Size of a pixel at a view depth of 1 m, metres: 2 tan(fov_y / 2) / height.
    pub pixel_m_at_1m: f32,
    /// Surface positions, metres from the frame's origin, which must be within about 1 km: rounding errors above half
    /// a pixel would be taken for silhouettes.
    pub positions: &'a [Vec3],
    /// Normals of the triangles, facing the camera, unit length.
    pub geometric_normals: &'a [Vec3],
    /// Depths along the view axis, metres; 0 or infinite where there is no geometry.
    pub view_depths_m: &'a [f32],
    /// Cosine between the geometric normal and the direction to the light, -1 to 1.
    pub n_dot_l: &'a [f32],
    /// Visibility of the light according to the technique, 0 to 1.
    pub visibility: &'a [f32],
    /// Hard reference: visibility of the light's centre, 0 or 1.
    pub truth: &'a [f32],
    /// Soft reference: visible fraction of the light, 0 to 1, if it was traced.
    pub soft_truth: Option<&'a [f32]>,
    /// Distance along the shadow ray to the nearest blocker, metres; infinite if there is none.
    pub blocker_distances_m: &'a [f32],
    /// Largest extent of a shadow texel on screen, pixels; 0 if unknown.
    pub texel_px: &'a [f32],
    /// Size of a shadow texel, metres; 0 if unknown.
    pub texel_m: &'a [f32],
    /// Direction towards the light.
    pub towards_light: TowardsLight<'a>,
}

/// Validated [`Images`]: all of the same size, with valid numbers.
#[derive(Clone, Copy, Debug)]
pub struct Samples<'a> {
    pub(super) images: Images<'a>,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl<'a> Samples<'a> {
    /// Validates the images.
    ///
    /// # Errors
    /// - [`MetricsError::Length`]: an image does not have width times height pixels.
    /// - [`MetricsError::Value`]: a visibility or truth of a receiver is not from 0 to 1, a position, normal or
    ///   light direction of a pixel with geometry is not finite, or a length or depth is NaN or negative.
    pub fn new(images: Images<'a>) -> Result<Self, MetricsError> {
        let [width, height] = images.size_px.map(|side| side as usize);
        let samples = Self { images, width, height };
        samples.check_lengths()?;
        samples.check_values()?;
        Ok(samples)
    }

    /// Returns the number of pixels.
    #[must_use]
    pub fn len(&self) -> usize {
        self.width * self.height
    }

    /// Returns whether there are no pixels.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns whether a pixel, below [`len`](Self::len), has geometry.
    #[must_use]
    pub fn is_drawn(&self, pixel: usize) -> bool {
        let depth_m = self.images.view_depths_m[pixel];
        depth_m > 0.0 && depth_m.is_finite()
    }

    /// Returns whether a pixel, below [`len`](Self::len), is a receiver: it has geometry with N·L above
    /// [`RECEIVER_N_DOT_L`].
    #[must_use]
    pub fn is_receiver(&self, pixel: usize) -> bool {
        self.is_drawn(pixel) && self.images.n_dot_l[pixel] > RECEIVER_N_DOT_L
    }

    pub(super) fn receivers(&self) -> impl Iterator<Item = usize> {
        (0..self.len()).filter(|&pixel| self.is_receiver(pixel))
    }

    pub(super) fn should_be_dark(&self, pixel: usize) -> bool {
        self.images.truth[pixel] < 0.5
    }

    /// Returns whether a pixel is dark according to the technique.
    pub(super) fn is_dark(&self, pixel: usize) -> bool {
        self.images.visibility[pixel] < 0.5
    }

    /// Returns |visibility - truth|, 0 to 1.
    pub(super) fn error(&self, pixel: usize) -> f32 {
        (self.images.visibility[pixel] - self.images.truth[pixel]).abs()
    }

    pub(super) fn is_misclassified(&self, pixel: usize) -> bool {
        self.error(pixel) > 0.5
    }

    pub(super) fn towards_light(&self, pixel: usize) -> Vec3 {
        match self.images.towards_light {
            TowardsLight::Uniform(direction) => direction,
            TowardsLight::PerPixel(directions) => directions[pixel],
        }
    }

    /// Returns the pixel at an offset `[right, down]`, if it is inside the image.
    pub(super) fn neighbour(&self, pixel: usize, [right, down]: [isize; 2]) -> Option<usize> {
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
            TowardsLight::Uniform(_) => Ok(()),
        }
    }

    fn check_values(&self) -> Result<(), MetricsError> {
        const FINITE: &str = "finite numbers";
        const FRACTION: &str = "0 to 1";
        const POSITIVE: &str = "0 and above";
        let images = &self.images;
        let side_m = images.pixel_m_at_1m;
        let distances_m = images.blocker_distances_m;
        let soft = images.soft_truth.unwrap_or(images.truth);
        let fraction = |values: &[f32], at: usize| (0.0..=1.0).contains(&values[at]);
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
        self.check("visibility", FRACTION, receiver, |at| fraction(images.visibility, at))?;
        self.check("truth", FRACTION, receiver, |at| fraction(images.truth, at))?;
        self.check("soft_truth", FRACTION, receiver, |at| fraction(soft, at))?;
        self.check("blocker_distances_m", POSITIVE, receiver, |at| distances_m[at] >= 0.0)
    }

    /// Returns an error for the first invalid number among the pixels that `counts` selects.
    fn check(
        &self,
        list: &'static str,
        allowed: &'static str,
        counts: impl Fn(usize) -> bool,
        valid: impl Fn(usize) -> bool,
    ) -> Result<(), MetricsError> {
        match (0..self.len()).position(|pixel| counts(pixel) && !valid(pixel)) {
            Some(index) => Err(MetricsError::Value { list, index, allowed }),
            None => Ok(()),
        }
    }
}

/// Error of invalid input to a metric.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MetricsError {
    /// A list has the wrong length.
    #[error("`{list}` has {has} entries; expected {needs}")]
    Length {
        /// Name of the list.
        list: &'static str,
        /// Its length.
        has: usize,
        /// The expected length.
        needs: usize,
    },
    /// A number is out of range or not finite.
    #[error("invalid value at index {index} of `{list}`; allowed: {allowed}")]
    Value {
        /// Name of the list.
        list: &'static str,
        /// Index in the list; for lists of frames, in the frame.
        index: usize,
        /// Allowed values.
        allowed: &'static str,
    },
}

/// Checks that a list has `needs` entries.
pub(super) fn check_length(list: &'static str, has: usize, needs: usize) -> Result<(), MetricsError> {
    if has == needs { Ok(()) } else { Err(MetricsError::Length { list, has, needs }) }
}

/// Checks that every value is from 0 to 1.
pub(super) fn check_fractions(list: &'static str, values: &[f32]) -> Result<(), MetricsError> {
    match values.iter().position(|value| !(0.0..=1.0).contains(value)) {
        Some(index) => Err(MetricsError::Value { list, index, allowed: "0 to 1" }),
        None => Ok(()),
    }
}

/// Cosine of 10 degrees: a crease is where the normals of neighbours differ by more.
pub const CREASE_COS: f32 = 0.984_807_8;

/// Distance from the other's tangent plane, in pixels, above which there is a silhouette between neighbours.
pub const STEP_PX: f32 = 0.5;

/// Rounding error of stored normals, radians.
const NORMAL_ROUNDING: f32 = 1e-3;

/// Returns whether two nearby pixels are on different surfaces: only one has geometry, or there is a crease or a
/// silhouette between them.
///
/// A silhouette is a step off the tangent plane, not one in depth: a plane seen at a grazing angle has none,
/// however far apart neighbours are. With d from one position to the other and normals a and b, it is where
/// |a·d| or |b·d| is above `STEP_PX` times the side of a pixel at the nearer of the two depths, plus |d| (|a
/// - b| + 0.001): a smooth bend from a to b explains |d| |a - b| / 2.
pub(super) fn is_disconnected(samples: &Samples<'_>, a: usize, b: usize) -> bool {
    if !samples.is_drawn(a) || !samples.is_drawn(b) {
        return samples.is_drawn(a) != samples.is_drawn(b);
    }
    let images = &samples.images;
    let (normal_a, normal_b) = (images.geometric_normals[a], images.geometric_normals[b]);
    if normal_a.dot(normal_b) < CREASE_COS {
        return true;
    }
    let between = images.positions[b] - images.positions[a];
    let footprint_m = images.pixel_m_at_1m * images.view_depths_m[a].min(images.view_depths_m[b]);
    let off_plane_m = normal_a.dot(between).abs().max(normal_b.dot(between).abs());
    let step_m = off_plane_m - STEP_PX * footprint_m;
    // Most neighbours end here, without a root.
    step_m > 0.0 && step_m > between.length() * ((normal_a - normal_b).length() + NORMAL_ROUNDING)
}
