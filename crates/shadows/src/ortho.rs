//! The axes of light space, and the box in it that a directional light's tile covers, fixed to whole texels of the world.

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4};
use shadowgraph_scene::{Aabb, BoundingSphere, ConvexVolume, Plane};

/// A box around a sphere in light space that moves through the world in whole texels only.
///
/// Width and height are those of `tile_px` texels; the depth range is twice that, so that the surroundings of the
/// sphere are not clamped to the near plane even where they slope steeply towards the light. The centre is a whole
/// number of texels from the world's origin across the light, so while rotation and radius are constant, each texel covers
/// the same area of the world. Along the light it moves in steps of a quarter of the radius, so depths rarely change as the
/// camera moves, and what was drawn stays valid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrthoFit {
    /// The rotation from world to light space, +Z towards the light.
    pub light_from_world: DMat3,
    /// The centre in light space, in texels from the world's origin: integers across the light.
    pub center_texels: DVec3,
    /// The longer side of a texel in the world, metres.
    pub texel_m: f64,
    /// The width and the height of a texel, as fractions of `texel_m`.
    pub texel_scale: DVec2,
    /// The width of the tile with its border, pixels.
    pub tile_px: u32,
    /// Factor of the depth range: a power of two, so that steps of whole texels stay exact.
    pub depth_scale: f64,
    /// The sphere, or a sphere around the points, that it was fitted to.
    pub sphere: BoundingSphere,
}

/// Number of steps per factor of two to which radii are rounded: a small change of the camera's angle changes no texel.
const RADIUS_STEPS: f64 = 32.0;

/// Number of steps per texel to which offsets from the frame's origin are rounded. With up to 20 bits of whole texels
/// (2 km of 2 mm texels) they fit an f32, so steps of whole texels reach the GPU exactly.
const PHASE_STEPS: f64 = 16.0;

/// Step along the light, in radii. It is the same for tiles of all sizes, so larger tiles cover no more than smaller ones.
const DEPTH_STEP: f64 = 0.25;

/// The shortest side of a tight box's texels, as a fraction of the other: filters are as wide in texels on both axes.
const MIN_TEXEL_SCALE: f64 = 0.25;

/// Distance from the centre to the far end, in half widths: half a step along the light more than the sphere needs.
const FAR: f64 = 1.0 + 0.5 * DEPTH_STEP;

impl OrthoFit {
    /// Fits the box to a sphere: wherever snapping moves the centre, the sphere stays `margin_px` away from the tile's edges.
    ///
    /// `margin_px` must be below half of `tile_px`.
    #[must_use]
    pub fn new(light_from_world: DMat3, sphere: BoundingSphere, tile_px: u32, margin_px: f64) -> Self {
        let center = light_from_world * sphere.center_world;
        Self::around(light_from_world, center, DVec2::splat(sphere.radius_m), tile_px, margin_px, sphere)
    }

    /// Fits the box tightly to points: it is as wide and as high as they are, and its texels change with them. Texels are at most four
    /// times as long as wide. Otherwise as [`new`](Self::new).
    #[must_use]
    pub fn tight(light_from_world: DMat3, points_world: &[DVec3], tile_px: u32, margin_px: f64) -> Self {
        let bounds = Aabb::from_points(points_world.iter().map(|&point| light_from_world * point));
        let half = bounds.half_extent();
        let center_world = light_from_world.transpose() * bounds.center();
        let sphere = BoundingSphere { center_world, radius_m: half.length() };
        let across = half.truncate().max(DVec2::splat(half.truncate().max_element() * MIN_TEXEL_SCALE));
        let fit = Self::around(light_from_world, bounds.center(), across, tile_px, margin_px, sphere);
        fit.deepened(half.z / fit.half_extent_m())
    }

    /// Fits the box to what is at most `half_m` away from a point in light space, on each axis across the light.
    fn around(
        light_from_world: DMat3,
        center: DVec3,
        half_m: DVec2,
        tile_px: u32,
        margin_px: f64,
        sphere: BoundingSphere,
    ) -> Self {
        let half_m =
            half_m.max(DVec2::splat(f64::MIN_POSITIVE.sqrt())).map(|half| round_up(half, RADIUS_STEPS));
        let texel = 2.0 * half_m / (f64::from(tile_px) - 2.0 * margin_px);
        let texel_m = texel.max_element();
        let across = (center.truncate() / texel).round();
        let step = DEPTH_STEP * half_m.max_element() / texel_m;
        let along = (center.z / texel_m / step).round() * step;
        let (center_texels, texel_scale) = (across.extend(along), texel / texel_m);
        Self { light_from_world, center_texels, texel_m, texel_scale, tile_px, depth_scale: 1.0, sphere }
    }

    /// Moves the centre to a multiple of `step_texels`, a power of two, in texels from the world's origin. So it moves in steps of as many.
    /// Points may be half of that nearer to the tile's edges.
    #[must_use]
    pub fn in_steps_of(self, step_texels: u32) -> Self {
        let step = f64::from(step_texels.max(1));
        let across = (self.center_texels.truncate() / step).round() * step;
        Self { center_texels: across.extend(self.center_texels.z), ..self }
    }

    /// Extends the depth range by at least `offset_m` (metres, 0 or more) towards the light.
    #[must_use]
    pub fn with_near_offset(self, offset_m: f64) -> Self {
        self.deepened(self.depth_scale + offset_m / (3.0 * self.half_extent_m()))
    }

    /// Returns the box with at least this factor of the depth range.
    fn deepened(self, scale: f64) -> Self {
        let depth_scale = scale.max(self.depth_scale).log2().ceil().exp2();
        Self { depth_scale, ..self }
    }

    /// Returns the longer one of half the width and half the height of the box, metres.
    #[must_use]
    pub fn half_extent_m(&self) -> f64 {
        self.texel_m * f64::from(self.tile_px) * 0.5
    }

    /// Returns the size of a texel, metres: its width, its height, and the unit of `center_texels` along the light.
    #[must_use]
    pub fn texel_size_m(&self) -> DVec3 {
        (self.texel_m * self.texel_scale).extend(self.texel_m)
    }

    /// Returns the centre in light space, metres from the world's origin.
    #[must_use]
    pub fn center_m(&self) -> DVec3 {
        self.center_texels * self.texel_size_m()
    }

    /// Returns the matrix from world space relative to `origin_world` to the tile: x right and y up from -1 to 1, z 1
    /// on the side of the light and 0 on the far side.
    #[must_use]
    pub fn clip_from_world(&self, origin_world: DVec3) -> DMat4 {
        let half_px = f64::from(self.tile_px) * 0.5;
        let rotation = DMat4::from_mat3(self.light_from_world);
        // In texels, every step of the camera adds integers.
        let origin_texels = self.light_from_world * origin_world / self.texel_size_m();
        let phase = (origin_texels * PHASE_STEPS).round() / PHASE_STEPS;
        let translation = DMat4::from_translation((phase - self.center_texels) / half_px);
        // x and y unchanged; four units of z, times the scale, to 0..1.
        let z = DVec4::Z * (0.25 / self.depth_scale);
        let depth = DMat4::from_cols(DVec4::X, DVec4::Y, z, DVec4::new(0.0, 0.0, 0.25 * FAR, 1.0));
        let scale = DMat4::from_scale(1.0 / (self.texel_size_m() * half_px));
        depth * translation * scale * rotation
    }

    /// Returns the depth range, metres.
    #[must_use]
    pub fn depth_range_m(&self) -> f64 {
        4.0 * self.half_extent_m() * self.depth_scale
    }

    /// Returns the volume whose casters matter: the box without its side towards the light, since casters nearer
    /// to the light cast shadows into it as well.
    #[must_use]
    pub fn cull_volume(&self) -> ConvexVolume {
        let center = self.center_m();
        let half = self.half_extent_m() * self.texel_scale;
        let axes = self.light_from_world.transpose();
        let sides = [(axes.x_axis, center.x, half.x), (axes.y_axis, center.y, half.y)];
        let mut planes = Vec::with_capacity(5);
        for (axis, middle, half) in sides {
            planes.push(Plane { normal: axis, distance: half - middle });
            planes.push(Plane { normal: -axis, distance: half + middle });
        }
        planes.push(Plane { normal: axes.z_axis, distance: -self.far_z_m() });
        ConvexVolume { planes }
    }

    /// Returns the corners of the part of the [culling volume](Self::cull_volume) that reaches to the end of all casters.
    pub(crate) fn caster_corners(&self, casters: &Aabb) -> [DVec3; 8] {
        let center = self.center_m();
        let half = (self.half_extent_m() * self.texel_scale).extend(0.0);
        let casters = casters.transformed(&DAffine3::from_mat3(self.light_from_world));
        let far = self.far_z_m();
        let bounds =
            Aabb { min: (center - half).with_z(far), max: (center + half).with_z(casters.max.z.max(far)) };
        bounds.corners().map(|corner| self.light_from_world.transpose() * corner)
    }

    /// Returns the far end of the depth range in light space, metres from the world's origin towards the light.
    #[must_use]
    pub fn far_z_m(&self) -> f64 {
        self.center_texels.z * self.texel_m - FAR * self.half_extent_m() * self.depth_scale
    }

    /// Returns the tile's first texel, counted from the world's origin: x to the right, y down.
    #[must_use]
    pub fn first_texel(&self) -> [i64; 2] {
        let half = i64::from(self.tile_px / 2);
        [self.center_texels.x as i64 - half, -self.center_texels.y as i64 - half]
    }

    /// Returns the part of [`cull_volume`](Self::cull_volume) around some texels: `size` of them from `first` on, counted as
    /// [`first_texel`](Self::first_texel) is. It is wider by `pad_texels` on each side.
    #[must_use]
    pub fn texels_volume(&self, first: [i64; 2], size: [u32; 2], pad_texels: f64) -> ConvexVolume {
        let axes = self.light_from_world.transpose();
        let ends = |i: usize| {
            let first = first[i] as f64;
            [first - pad_texels, first + f64::from(size[i]) + pad_texels]
        };
        let texel = self.texel_size_m();
        let [[left, right], [top, bottom]] = [0, 1].map(|i| ends(i).map(|end| end * texel[i]));
        let planes = vec![
            Plane { normal: axes.x_axis, distance: -left },
            Plane { normal: -axes.x_axis, distance: right },
            Plane { normal: -axes.y_axis, distance: -top },
            Plane { normal: axes.y_axis, distance: bottom },
            Plane { normal: axes.z_axis, distance: -self.far_z_m() },
        ];
        ConvexVolume { planes }
    }
}

/// Rounds `value` (above 0) up to one of `steps` equal steps per factor of two.
fn round_up(value: f64, steps: f64) -> f64 {
    let step = value.log2().floor().exp2() / steps;
    (value / step).ceil() * step
}

/// Angle of the axes around the light, radians: the arc tangent of 1/2. Edges of buildings are vertical or along the world's axes. If
/// they were parallel to texels, a whole edge would move from one row of texels to the next at once.
const ROLL: f64 = 0.463_647_609_000_806_1;

/// Returns the rotation from world to light space, +Z towards the light: that of a light from straight above, turned along the
/// shortest arc, so that the axes turn as little as possible with the light, and do not jump, except for lights from straight
/// below. No axis across the light is along the world's. It depends only on the direction, so it is constant while the camera moves.
/// `None` for a direction that is zero or not finite.
///
/// ```
/// use glam::DVec3;
/// use shadowgraph_shadows::light_from_world;
/// let rotation = light_from_world(DVec3::NEG_Y).ok_or("no direction")?;
/// assert_eq!(rotation * DVec3::Y, DVec3::Z);
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn light_from_world(direction: DVec3) -> Option<DMat3> {
    let towards_light = -direction.try_normalize()?;
    // The world's +X on that arc.
    let sum = DVec3::Y + towards_light;
    let along = DVec3::X - sum * (towards_light.x / sum.y.max(f64::EPSILON));
    let up = towards_light.cross(along).try_normalize()?;
    let right = up.cross(towards_light);
    let (sin, cos) = ROLL.sin_cos();
    // Rows of the result: a transposed matrix of the axes is its inverse, exactly.
    Some(DMat3::from_cols(right * cos + up * sin, up * cos - right * sin, towards_light).transpose())
}

/// Absolute cosine to the vertical above which the up axis of [`upright_from_world`] is computed from the world's -Z instead of +Y.
const STEEP: f64 = 0.999;

/// Returns the rotation for a tile of a spot or point light: +Z towards the light, +Y as close to the world's up as possible, so the
/// axes of a point light's tiles are those of the world. Otherwise as [`light_from_world`].
pub(crate) fn upright_from_world(direction: DVec3) -> Option<DMat3> {
    let towards_light = -direction.try_normalize()?;
    let up = if towards_light.y.abs() > STEEP { DVec3::NEG_Z } else { DVec3::Y };
    let right = up.cross(towards_light).try_normalize()?;
    Some(DMat3::from_cols(right, towards_light.cross(right), towards_light).transpose())
}
