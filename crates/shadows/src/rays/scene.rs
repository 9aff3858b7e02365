//! The scene that rays are traced through on the CPU.

use std::cell::Cell;

use glam::{Vec2, Vec3};
use obvhs::{
    bvh2::Bvh2,
    ray::{INVALID_ID, RayHit},
};

use super::{
    ChannelTexture, Error, Occluder, Ray, TriangleHit,
    gpu_structs::{NO_MATERIAL, NO_TEXTURE, RayMaterial, RayTriangle, TINT, unpacked},
    tree,
};

/// Largest number of occluders: the indices of the tree's nodes fit into u32.
const MAX_OCCLUDERS: usize = 1 << 30;

/// Triangles, channels of textures, and a tree over the triangles.
#[derive(Clone)]
pub struct RayScene {
    bvh: Bvh2,
    /// The triangles, in the order of the tree's leaves.
    triangles: Vec<RayTriangle>,
    materials: Vec<RayMaterial>,
    textures: Vec<ChannelTexture>,
    dropped: usize,
    max_coordinate_m: f32,
}

impl RayScene {
    /// Builds the tree. Occluders that are not [valid](Occluder::is_valid) are dropped. A scene without occluders is
    /// allowed: nothing is blocked.
    ///
    /// # Errors
    ///
    /// [`Error::NoTexture`] if a surface refers to a channel beyond the last, [`Error::TooMany`] past 2^30 occluders.
    pub fn new(occluders: &[Occluder], textures: Vec<ChannelTexture>) -> Result<Self, Error> {
        check(occluders, textures.len())?;
        let valid: Vec<&Occluder> = occluders.iter().filter(|occluder| occluder.is_valid()).collect();
        let corners = || valid.iter().flat_map(|occluder| occluder.corners);
        let max_coordinate_m = corners().map(|corner| corner.abs().max_element()).fold(0.0, f32::max);
        let bvh = tree::build(&valid, max_coordinate_m);
        let mut materials = Vec::new();
        let mut triangle = |occluder: &Occluder| {
            let material = RayMaterial::new(&occluder.surface).map_or(NO_MATERIAL, |material| {
                materials.push(material);
                (materials.len() - 1) as u32
            });
            RayTriangle::new(occluder.corners, material)
        };
        let in_order = bvh.primitive_indices.iter().filter_map(|&index| valid.get(index as usize));
        let triangles = in_order.map(|occluder| triangle(occluder)).collect();
        let dropped = occluders.len() - valid.len();
        Ok(Self { bvh, triangles, materials, textures, dropped, max_coordinate_m })
    }

    /// Returns whether the ray hits an opaque surface.
    #[must_use]
    pub fn is_occluded(&self, ray: &Ray) -> bool {
        let distance = |_: &obvhs::ray::Ray, index| self.distance(ray, index).unwrap_or(f32::INFINITY);
        !self.bvh.ray_traverse_miss(ray.for_boxes(), distance)
    }

    /// Returns the transmittance along the ray, linear red, green and blue, 0 to 1.
    #[must_use]
    pub fn transmittance(&self, ray: &Ray) -> Vec3 {
        let transmittance = Cell::new(Vec3::ONE);
        let distance = |_: &obvhs::ray::Ray, index| match self.hit(ray, index) {
            Some(Hit { distance_m, transmittance: None }) => distance_m,
            Some(Hit { transmittance: Some(factor), .. }) => {
                transmittance.set(transmittance.get() * factor);
                f32::INFINITY
            }
            None => f32::INFINITY,
        };
        if self.bvh.ray_traverse_miss(ray.for_boxes(), distance) { transmittance.get() } else { Vec3::ZERO }
    }

    /// Returns the distance along the ray to the first opaque surface, metres.
    #[must_use]
    pub fn nearest_distance(&self, ray: &Ray) -> Option<f32> {
        self.nearest_triangle(ray).map(|(distance_m, _)| distance_m)
    }

    /// Returns the [nearest distance](Self::nearest_distance) and the index of the hit [triangle](Self::triangles).
    #[must_use]
    pub fn nearest_triangle(&self, ray: &Ray) -> Option<(f32, usize)> {
        let distance = |_: &obvhs::ray::Ray, index| self.distance(ray, index).unwrap_or(f32::INFINITY);
        let mut hit = RayHit::none();
        self.bvh.ray_traverse(ray.for_boxes(), &mut hit, distance);
        (hit.primitive_id != INVALID_ID).then_some((hit.t, hit.primitive_id as usize))
    }

    /// Returns the [nearest distance](Self::nearest_distance) by a test of every triangle: slow, for tests of the tree.
    #[must_use]
    pub fn nearest_distance_brute_force(&self, ray: &Ray) -> Option<f32> {
        (0..self.triangles.len()).filter_map(|index| self.distance(ray, index)).reduce(f32::min)
    }

    /// Returns [whether the ray is occluded](Self::is_occluded) by a test of every triangle: slow, for tests of the tree.
    #[must_use]
    pub fn is_occluded_brute_force(&self, ray: &Ray) -> bool {
        (0..self.triangles.len()).any(|index| self.distance(ray, index).is_some())
    }

    /// Returns the [transmittance](Self::transmittance) by a test of every triangle: slow, for tests of the tree.
    #[must_use]
    pub fn transmittance_brute_force(&self, ray: &Ray) -> Vec3 {
        let hits = (0..self.triangles.len()).filter_map(|index| self.hit(ray, index));
        hits.map(|hit| hit.transmittance.unwrap_or(Vec3::ZERO)).product()
    }

    /// Returns the triangles that can be hit, in the tree's order.
    #[must_use]
    pub fn triangles(&self) -> &[RayTriangle] {
        &self.triangles
    }

    /// Returns the number of occluders that were dropped because they are not [valid](Occluder::is_valid).
    #[must_use]
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// Returns the largest absolute coordinate of any corner, metres.
    #[must_use]
    pub fn max_coordinate_m(&self) -> f32 {
        self.max_coordinate_m
    }

    pub(crate) fn bvh(&self) -> &Bvh2 {
        &self.bvh
    }

    pub(crate) fn materials(&self) -> &[RayMaterial] {
        &self.materials
    }

    pub(crate) fn textures(&self) -> &[ChannelTexture] {
        &self.textures
    }

    /// Returns the distance along the ray to this triangle, if it is hit at an opaque point.
    fn distance(&self, ray: &Ray, index: usize) -> Option<f32> {
        self.hit(ray, index).filter(|hit| hit.transmittance.is_none()).map(|hit| hit.distance_m)
    }

    /// Returns the hit of this triangle, unless it is in a hole.
    fn hit(&self, ray: &Ray, index: usize) -> Option<Hit> {
        let triangle = self.triangles.get(index)?;
        let TriangleHit { distance_m, weights } = ray.hit(triangle.corners())?;
        let Some(material) = self.materials.get(triangle.material as usize) else {
            return Some(Hit { distance_m, transmittance: None });
        };
        let alpha = self.alpha(material, weights);
        if material.cutoff != TINT {
            return (alpha >= material.cutoff).then_some(Hit { distance_m, transmittance: None });
        }
        let alpha = alpha.clamp(0.0, 1.0);
        let transmittance =
            (1.0 - alpha) * Vec3::ONE.lerp(self.color(material, weights), alpha * (2.0 - alpha));
        Some(Hit { distance_m, transmittance: Some(transmittance) })
    }

    fn alpha(&self, material: &RayMaterial, weights: Vec3) -> f32 {
        material.alpha.dot(weights) * self.value(material, 0, weights)
    }

    fn color(&self, material: &RayMaterial, weights: Vec3) -> Vec3 {
        let [a, b, c] = material.color.map(unpacked);
        let factor = a * weights.x + b * weights.y + c * weights.z;
        factor * Vec3::from([1, 2, 3].map(|channel| self.value(material, channel, weights)))
    }

    /// Returns the value of a channel at a point; 1 without a texture.
    fn value(&self, material: &RayMaterial, channel: usize, weights: Vec3) -> f32 {
        if material.texture == NO_TEXTURE {
            return 1.0;
        }
        let uv: Vec2 = material.uv_a * weights.x + material.uv_b * weights.y + material.uv_c * weights.z;
        self.textures.get(material.texture as usize + channel).map_or(1.0, |texture| texture.value(uv))
    }
}

/// A hit of a triangle.
struct Hit {
    distance_m: f32,
    /// The transmittance; `None` at an opaque point.
    transmittance: Option<Vec3>,
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
