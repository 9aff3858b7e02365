//! The scene that rays are traced through on the CPU.

use glam::{Vec2, Vec3};
use obvhs::{
    bvh2::Bvh2,
    ray::{INVALID_ID, RayHit},
};

use super::{
    AlphaTexture, Error, Occluder, Ray,
    records::{NO_CUT, NO_TEXTURE, RayCut, RayTriangle},
    tree,
};

/// So many that the tree's nodes can be numbered in u32.
const MAX_OCCLUDERS: usize = 1 << 30;

/// Triangles, alpha textures, and a tree over the triangles.
#[derive(Clone)]
pub struct RayScene {
    bvh: Bvh2,
    /// In the order in which the tree's leaves name them.
    triangles: Vec<RayTriangle>,
    cuts: Vec<RayCut>,
    textures: Vec<AlphaTexture>,
    dropped: usize,
    reach_m: f32,
}

impl RayScene {
    /// Builds the tree. Occluders that are not [sound](Occluder::is_sound) are dropped. No occluders are
    /// allowed: nothing is then blocked.
    ///
    /// # Errors
    ///
    /// [`Error::NoAlphaTexture`] if a cut names a texture beyond the last, [`Error::TooMany`] past 2^30 occluders.
    pub fn new(occluders: &[Occluder], textures: Vec<AlphaTexture>) -> Result<Self, Error> {
        check(occluders, textures.len())?;
        let sound: Vec<&Occluder> = occluders.iter().filter(|occluder| occluder.is_sound()).collect();
        let corners = || sound.iter().flat_map(|occluder| occluder.corners);
        let reach_m = corners().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        let bvh = tree::build(&sound, reach_m);
        let mut cuts = Vec::new();
        let mut record = |occluder: &Occluder| {
            let cut = occluder.cut.map_or(NO_CUT, |cut| {
                cuts.push(RayCut::new(&cut));
                (cuts.len() - 1) as u32
            });
            RayTriangle::new(occluder.corners, cut)
        };
        let in_order = bvh.primitive_indices.iter().filter_map(|&index| sound.get(index as usize));
        let triangles = in_order.map(|occluder| record(occluder)).collect();
        let dropped = occluders.len() - sound.len();
        Ok(Self { bvh, triangles, cuts, textures, dropped, reach_m })
    }

    /// Tells whether the ray meets anything but holes.
    #[must_use]
    pub fn blocked(&self, ray: &Ray) -> bool {
        let distance = |_: &obvhs::ray::Ray, index| self.distance(ray, index).unwrap_or(f32::INFINITY);
        !self.bvh.ray_traverse_miss(ray.for_boxes(), distance)
    }

    /// The distance along the ray to the first thing it meets that is not a hole, metres.
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

    pub(crate) fn textures(&self) -> &[AlphaTexture] {
        &self.textures
    }

    fn distance(&self, ray: &Ray, index: usize) -> Option<f32> {
        let triangle = self.triangles.get(index)?;
        let hit = ray.hit(triangle.corners())?;
        let cut = self.cuts.get(triangle.cut as usize);
        let hole = cut.is_some_and(|cut| self.alpha(cut, hit.weights) < cut.cutoff);
        (!hole).then_some(hit.distance_m)
    }

    fn alpha(&self, cut: &RayCut, weights: Vec3) -> f32 {
        let factor = cut.alpha.x * weights.x + cut.alpha.y * weights.y + cut.alpha.z * weights.z;
        let uv: Vec2 = cut.uv_a * weights.x + cut.uv_b * weights.y + cut.uv_c * weights.z;
        let texture = if cut.texture == NO_TEXTURE { None } else { self.textures.get(cut.texture as usize) };
        factor * texture.map_or(1.0, |texture| texture.alpha(uv))
    }
}

fn check(occluders: &[Occluder], count: usize) -> Result<(), Error> {
    if occluders.len() > MAX_OCCLUDERS {
        return Err(Error::TooMany { count: occluders.len(), limit: MAX_OCCLUDERS });
    }
    for (occluder, cut) in occluders.iter().enumerate().filter_map(|(i, occluder)| Some((i, occluder.cut?))) {
        if let Some(texture) = cut.texture.filter(|&texture| texture as usize >= count) {
            return Err(Error::NoAlphaTexture { occluder, texture, count });
        }
    }
    Ok(())
}
