//! The scene that rays are traced through on the CPU.

use std::cell::Cell;

use glam::{Vec2, Vec3};
use obvhs::{
    bvh2::Bvh2,
    ray::{INVALID_ID, RayHit},
};

use super::{
    ChannelTexture, Error, Occluder, Ray, TriangleHit,
    records::{NO_CUT, NO_TEXTURE, RayCut, RayTriangle, TINT, unpacked},
    tree,
};

/// So many that the tree's nodes can be numbered in u32.
const MAX_OCCLUDERS: usize = 1 << 30;

/// Triangles, channels of textures, and a tree over the triangles.
#[derive(Clone)]
pub struct RayScene {
    bvh: Bvh2,
    /// In the order in which the tree's leaves name them.
    triangles: Vec<RayTriangle>,
    cuts: Vec<RayCut>,
    textures: Vec<ChannelTexture>,
    dropped: usize,
    reach_m: f32,
}

impl RayScene {
    /// Builds the tree. Occluders that are not [sound](Occluder::is_sound) are dropped. No occluders are
    /// allowed: nothing is then blocked.
    ///
    /// # Errors
    ///
    /// [`Error::NoTexture`] if a surface names a channel beyond the last, [`Error::TooMany`] past 2^30 occluders.
    pub fn new(occluders: &[Occluder], textures: Vec<ChannelTexture>) -> Result<Self, Error> {
        check(occluders, textures.len())?;
        let sound: Vec<&Occluder> = occluders.iter().filter(|occluder| occluder.is_sound()).collect();
        let corners = || sound.iter().flat_map(|occluder| occluder.corners);
        let reach_m = corners().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        let bvh = tree::build(&sound, reach_m);
        let mut cuts = Vec::new();
        let mut record = |occluder: &Occluder| {
            let cut = RayCut::new(&occluder.surface).map_or(NO_CUT, |cut| {
                cuts.push(cut);
                (cuts.len() - 1) as u32
            });
            RayTriangle::new(occluder.corners, cut)
        };
        let in_order = bvh.primitive_indices.iter().filter_map(|&index| sound.get(index as usize));
        let triangles = in_order.map(|occluder| record(occluder)).collect();
        let dropped = occluders.len() - sound.len();
        Ok(Self { bvh, triangles, cuts, textures, dropped, reach_m })
    }

    /// Tells whether the ray meets anything but holes and what is translucent.
    #[must_use]
    pub fn blocked(&self, ray: &Ray) -> bool {
        let distance = |_: &obvhs::ray::Ray, index| self.distance(ray, index).unwrap_or(f32::INFINITY);
        !self.bvh.ray_traverse_miss(ray.for_boxes(), distance)
    }

    /// Returns what of light passes along the ray, linear red, green and blue, 0 to 1.
    #[must_use]
    pub fn passed(&self, ray: &Ray) -> Vec3 {
        let passed = Cell::new(Vec3::ONE);
        let distance = |_: &obvhs::ray::Ray, index| match self.meet(ray, index) {
            Some(Meeting { distance_m, passed: None }) => distance_m,
            Some(Meeting { passed: Some(part), .. }) => {
                passed.set(passed.get() * part);
                f32::INFINITY
            }
            None => f32::INFINITY,
        };
        if self.bvh.ray_traverse_miss(ray.for_boxes(), distance) { passed.get() } else { Vec3::ZERO }
    }

    /// The distance along the ray to the first thing it meets that is neither a hole nor translucent, metres.
    #[must_use]
    pub fn nearest(&self, ray: &Ray) -> Option<f32> {
        self.nearest_triangle(ray).map(|(distance_m, _)| distance_m)
    }

    /// The same as [`nearest`](Self::nearest), and which of the [`triangles`](Self::triangles) it is.
    #[must_use]
    pub fn nearest_triangle(&self, ray: &Ray) -> Option<(f32, usize)> {
        let distance = |_: &obvhs::ray::Ray, index| self.distance(ray, index).unwrap_or(f32::INFINITY);
        let mut hit = RayHit::none();
        self.bvh.ray_traverse(ray.for_boxes(), &mut hit, distance);
        (hit.primitive_id != INVALID_ID).then_some((hit.t, hit.primitive_id as usize))
    }

    /// The same as [`nearest`](Self::nearest) by a test of every triangle: slow, for tests of the tree.
    #[must_use]
    pub fn nearest_of_all(&self, ray: &Ray) -> Option<f32> {
        (0..self.triangles.len()).filter_map(|index| self.distance(ray, index)).reduce(f32::min)
    }

    /// The same as [`blocked`](Self::blocked) by a test of every triangle: slow, for tests of the tree.
    #[must_use]
    pub fn blocked_by_any_of_all(&self, ray: &Ray) -> bool {
        (0..self.triangles.len()).any(|index| self.distance(ray, index).is_some())
    }

    /// The same as [`passed`](Self::passed) by a test of every triangle: slow, for tests of the tree.
    #[must_use]
    pub fn passed_by_all(&self, ray: &Ray) -> Vec3 {
        let meetings = (0..self.triangles.len()).filter_map(|index| self.meet(ray, index));
        meetings.map(|meeting| meeting.passed.unwrap_or(Vec3::ZERO)).product()
    }

    /// The triangles that can be hit, in the tree's order.
    #[must_use]
    pub fn triangles(&self) -> &[RayTriangle] {
        &self.triangles
    }

    /// How many occluders were dropped as not [sound](Occluder::is_sound).
    #[must_use]
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// The largest coordinate of any corner, either sign, metres.
    #[must_use]
    pub fn reach_m(&self) -> f32 {
        self.reach_m
    }

    pub(crate) fn bvh(&self) -> &Bvh2 {
        &self.bvh
    }

    pub(crate) fn cuts(&self) -> &[RayCut] {
        &self.cuts
    }

    pub(crate) fn textures(&self) -> &[ChannelTexture] {
        &self.textures
    }

    /// How far along the ray it is to this triangle, if it is hit and no light passes there.
    fn distance(&self, ray: &Ray, index: usize) -> Option<f32> {
        self.meet(ray, index).filter(|meeting| meeting.passed.is_none()).map(|meeting| meeting.distance_m)
    }

    /// Where the ray meets this triangle, unless in a hole.
    fn meet(&self, ray: &Ray, index: usize) -> Option<Meeting> {
        let triangle = self.triangles.get(index)?;
        let TriangleHit { distance_m, weights } = ray.hit(triangle.corners())?;
        let Some(cut) = self.cuts.get(triangle.cut as usize) else {
            return Some(Meeting { distance_m, passed: None });
        };
        let alpha = self.alpha(cut, weights);
        if cut.cutoff != TINT {
            return (alpha >= cut.cutoff).then_some(Meeting { distance_m, passed: None });
        }
        let alpha = alpha.clamp(0.0, 1.0);
        let passed = (1.0 - alpha) * Vec3::ONE.lerp(self.color(cut, weights), alpha * (2.0 - alpha));
        Some(Meeting { distance_m, passed: Some(passed) })
    }

    fn alpha(&self, cut: &RayCut, weights: Vec3) -> f32 {
        cut.alpha.dot(weights) * self.value(cut, 0, weights)
    }

    fn color(&self, cut: &RayCut, weights: Vec3) -> Vec3 {
        let [a, b, c] = cut.color.map(unpacked);
        let factor = a * weights.x + b * weights.y + c * weights.z;
        factor * Vec3::from([1, 2, 3].map(|channel| self.value(cut, channel, weights)))
    }

    /// What one of its channels has at a point; 1 without any.
    fn value(&self, cut: &RayCut, channel: usize, weights: Vec3) -> f32 {
        if cut.texture == NO_TEXTURE {
            return 1.0;
        }
        let uv: Vec2 = cut.uv_a * weights.x + cut.uv_b * weights.y + cut.uv_c * weights.z;
        self.textures.get(cut.texture as usize + channel).map_or(1.0, |texture| texture.value(uv))
    }
}

/// Where a ray meets a triangle.
struct Meeting {
    distance_m: f32,
    /// What of the light passes there; `None`: it is stopped.
    passed: Option<Vec3>,
}

fn check(occluders: &[Occluder], count: usize) -> Result<(), Error> {
    if occluders.len() > MAX_OCCLUDERS {
        return Err(Error::TooMany { count: occluders.len(), limit: MAX_OCCLUDERS });
    }
    for (occluder, surface) in occluders.iter().map(|occluder| &occluder.surface).enumerate() {
        if let Some((first, channels)) = surface.channels()
            && let Some(texture) =
                (first..first.saturating_add(channels)).find(|&texture| texture as usize >= count)
        {
            return Err(Error::NoTexture { occluder, texture, count });
        }
    }
    Ok(())
}
