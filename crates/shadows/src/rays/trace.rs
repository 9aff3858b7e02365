//! Rays through a scene on the CPU: the same traversal and arithmetic as in `rays.wgsl`.

use std::ops::ControlFlow::{self, Break, Continue};

use glam::{Vec2, Vec3, Vec3A, Vec4};

use super::channel::Channel;
use super::gpu_structs::{
    RAY_INSTANCE, RAY_NONE, RayInstance, RayNode, RaySurface, RayTexture, RayTriangle, TINT, transformed,
    unpacked,
};
use super::instance::BOX_MARGIN;
use super::tree::{MESH_DEPTH, TOP_DEPTH};
use super::{Ray, RayInstanceKey, RayScene, TriangleHit};

/// The nearest opaque point along a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestHit {
    /// Distance along the ray, metres.
    pub distance_m: f32,
    /// The corners of the hit triangle, metres relative to the origin.
    pub corners: [Vec3; 3],
    /// The instance that was hit.
    pub instance: RayInstanceKey,
}

impl RayScene {
    /// Returns whether the ray hits an opaque surface.
    #[must_use]
    pub fn is_occluded(&self, ray: &Ray) -> bool {
        let opaque = |(_, instance): (u32, &_), triangle: &_, _| match self.hit(ray, instance, triangle) {
            Some(Hit { transmittance: None, .. }) => Break(()),
            _ => Continue(ray.max_m()),
        };
        self.traverse(ray, opaque).is_break()
    }

    /// Returns the transmittance along the ray, linear red, green and blue, 0 to 1.
    #[must_use]
    pub fn transmittance(&self, ray: &Ray) -> Vec3 {
        let mut transmittance = Vec3::ONE;
        let pass = |(_, instance): (u32, &_), triangle: &_, _| {
            match self.hit(ray, instance, triangle) {
                Some(Hit { transmittance: None, .. }) => return Break(()),
                Some(Hit { transmittance: Some(factor), .. }) => transmittance *= factor,
                None => {}
            }
            Continue(ray.max_m())
        };
        if self.traverse(ray, pass).is_break() { Vec3::ZERO } else { transmittance }
    }

    /// Returns the distance along the ray to the first opaque surface, metres.
    #[must_use]
    pub fn nearest_distance(&self, ray: &Ray) -> Option<f32> {
        self.nearest(ray).map(|(_, distance_m, _)| distance_m)
    }

    /// Returns the first opaque point along the ray. Its instance is found by a search among all.
    #[must_use]
    pub fn nearest_hit(&self, ray: &Ray) -> Option<NearestHit> {
        let (index, distance_m, corners) = self.nearest(ray)?;
        Some(NearestHit { distance_m, corners, instance: self.instance_at(index)? })
    }

    /// Returns the first opaque point along the ray: the index of its instance, the distance in metres, and the corners of the triangle.
    fn nearest(&self, ray: &Ray) -> Option<(u32, f32, [Vec3; 3])> {
        let mut nearest = None;
        let nearer = |(index, instance): (u32, &RayInstance), triangle: &_, end_m| {
            let hit = self.hit(ray, instance, triangle);
            let Some(Hit { distance_m, transmittance: None }) = hit else { return Continue(end_m) };
            if distance_m >= end_m {
                return Continue(end_m);
            }
            nearest = Some((index, distance_m, instance.corners(triangle)));
            Continue(distance_m)
        };
        // Never breaks.
        let _ = self.traverse(ray, nearer);
        nearest
    }

    /// Returns the [nearest distance](Self::nearest_distance) by a test of every triangle: slow, for tests of the trees.
    #[must_use]
    pub fn nearest_distance_brute_force(&self, ray: &Ray) -> Option<f32> {
        let opaque = self.hits(ray).filter(|hit| hit.transmittance.is_none());
        opaque.map(|hit| hit.distance_m).reduce(f32::min)
    }

    /// Returns the [transmittance](Self::transmittance) by a test of every triangle: slow, for tests of the trees.
    #[must_use]
    pub fn transmittance_brute_force(&self, ray: &Ray) -> Vec3 {
        self.hits(ray).map(|hit| hit.transmittance.unwrap_or(Vec3::ZERO)).product()
    }

    /// Returns the number of triangles that can be hit, over all instances.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.all().map(|(_, triangles)| triangles.len()).sum()
    }

    /// Returns the hits of all triangles.
    fn hits(&self, ray: &Ray) -> impl Iterator<Item = Hit> {
        self.all().flat_map(|(instance, triangles)| {
            triangles.iter().filter_map(|triangle| self.hit(ray, instance, triangle))
        })
    }

    /// Calls `visit` for the triangles whose boxes the ray enters before its end, which `visit` returns, roughly from near to far.
    fn traverse(
        &self,
        ray: &Ray,
        mut visit: impl FnMut((u32, &RayInstance), &RayTriangle, f32) -> ControlFlow<(), f32>,
    ) -> ControlFlow<()> {
        let (nodes, instances) = (self.nodes.elements(), self.instances.elements());
        let coordinates_m = self.max_coordinate_m() + ray.origin().abs().max_element();
        let world = Slabs::new(ray.origin(), ray.direction(), Vec3::splat(BOX_MARGIN * coordinates_m));
        let mut end_m = ray.max_m();
        let (mut stack, mut height) = ([0; MESH_DEPTH + TOP_DEPTH], 0);
        // The current level: the ray in its space, its instance, and the height of the stack below it.
        let (mut slabs, mut instance, mut base) = (world, (0, &RayInstance::default()), 0);
        // A pair of nodes or an instance. The root is in no pair, so 0 means none.
        let mut next = if world.enters(&nodes[0]) < end_m { nodes[0].first } else { 0 };
        loop {
            if next == 0 {
                if height == base {
                    (slabs, base) = (world, 0);
                }
                if height == 0 {
                    return Continue(());
                }
                height -= 1;
                next = stack[height];
            }
            let mut entered = [(f32::INFINITY, 0); 2];
            if next & RAY_INSTANCE == 0 {
                entered = [next, next + 1].map(|index| (slabs.enters(&nodes[index as usize]), index));
                if entered[0].0 > entered[1].0 {
                    entered.swap(0, 1);
                }
            } else {
                let index = next & !RAY_INSTANCE;
                instance = (index, &instances[index as usize]);
                slabs = slabs_in_mesh(ray, instance.1, coordinates_m);
                base = height;
                let root = instance.1.root;
                entered[0] = (slabs.enters(&nodes[root as usize]), root);
            }
            next = 0;
            for (enters, index) in entered {
                let RayNode { first, count, .. } = nodes[index as usize];
                if enters >= end_m {
                    continue;
                }
                if count > 0 {
                    for triangle in self.triangles.slice(first..first + count) {
                        end_m = visit(instance, triangle, end_m)?;
                    }
                } else if next == 0 {
                    next = first;
                } else {
                    stack[height] = first;
                    height += 1;
                }
            }
        }
    }

    /// Returns the hit of a triangle, unless it is in a hole.
    fn hit(&self, ray: &Ray, instance: &RayInstance, triangle: &RayTriangle) -> Option<Hit> {
        let corners = triangle.corners().map(|corner| transformed(&instance.world_from_mesh, corner));
        let TriangleHit { distance_m, weights } = ray.hit(corners)?;
        if instance.first_surface == RAY_NONE {
            return Some(Hit { distance_m, transmittance: None });
        }
        let surface = self.surfaces.get(instance.first_surface + triangle.index);
        let alpha = surface.alpha.dot(weights) * self.value(&surface, 0, weights);
        if surface.cutoff != TINT {
            return (alpha >= surface.cutoff).then_some(Hit { distance_m, transmittance: None });
        }
        let alpha = alpha.clamp(0.0, 1.0);
        let density = if surface.transmits == 0 { alpha * (2.0 - alpha) } else { 1.0 };
        let transmittance = (1.0 - alpha) * Vec3::ONE.lerp(self.color(&surface, weights), density);
        Some(Hit { distance_m, transmittance: Some(transmittance) })
    }

    fn color(&self, surface: &RaySurface, weights: Vec3) -> Vec3 {
        let [a, b, c] = surface.color.map(unpacked);
        let factor = a * weights.x + b * weights.y + c * weights.z;
        factor * Vec3::from([1, 2, 3].map(|channel| self.value(surface, channel, weights)))
    }

    /// Returns the value of a channel at a point; 1 without a texture.
    fn value(&self, surface: &RaySurface, channel: u32, weights: Vec3) -> f32 {
        if surface.texture == RAY_NONE {
            return 1.0;
        }
        let first = surface.texture + channel * 4;
        let words = self.words.elements();
        let [first_texel, width, height, sampling] =
            [0, 1, 2, 3].map(|word| u32::from_le_bytes(self.words.get(first + word)));
        let header = RayTexture { first_texel, width, height, sampling };
        let uv: Vec2 = surface.uv_a * weights.x + surface.uv_b * weights.y + surface.uv_c * weights.z;
        Channel::new(header, words.as_flattened()).value(uv)
    }
}

/// Returns a ray in the space of an instance's mesh. The direction is not normalized, so that distances are those of the world.
fn slabs_in_mesh(ray: &Ray, instance: &RayInstance, coordinates_m: f32) -> Slabs {
    let [origin, direction] = [ray.origin().extend(1.0), ray.direction().extend(0.0)]
        .map(|vector| Vec3::from(instance.mesh_from_world.map(|row| row.dot(vector))));
    Slabs::new(origin, direction, instance.margin * coordinates_m)
}

/// A hit of a triangle.
struct Hit {
    distance_m: f32,
    /// The transmittance; `None` at an opaque point.
    transmittance: Option<Vec3>,
}

/// A ray in the space of some boxes, which are widened by a margin.
#[derive(Clone, Copy)]
struct Slabs {
    to_lowest: Vec3A,
    to_highest: Vec3A,
    inverse: Vec3A,
}

impl Slabs {
    fn new(origin: Vec3, direction: Vec3, margin: Vec3) -> Self {
        let inverse = direction.to_array().map(|d| 1.0 / if d.abs() < 1e-20 { 1e-20 } else { d });
        let (to_lowest, to_highest) = ((origin + margin).into(), (origin - margin).into());
        Self { to_lowest, to_highest, inverse: inverse.into() }
    }

    /// Returns the distance along the ray at which it enters the box, below 0 if the origin is inside; infinite if it misses.
    fn enters(&self, node: &RayNode) -> f32 {
        let [lowest, highest] = bytemuck::cast::<_, [Vec4; 2]>(*node).map(Vec3A::from_vec4);
        let (a, b) = ((lowest - self.to_lowest) * self.inverse, (highest - self.to_highest) * self.inverse);
        let (enters, leaves) = (a.min(b).max_element(), a.max(b).min_element());
        if leaves >= enters && leaves >= 0.0 { enters } else { f32::INFINITY }
    }
}
