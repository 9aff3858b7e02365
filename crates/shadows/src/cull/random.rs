//! Random views and lights for the tests, and distances computed without planes.

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use shadowgraph_scene::{Camera, Projection};

use super::receivers::ReceiverHull;

/// A slice of a camera's frustum.
#[derive(Clone, Debug)]
pub(crate) struct View {
    pub(crate) camera: Camera,
    pub(crate) aspect: f64,
    pub(crate) near_m: f64,
    pub(crate) far_m: f64,
}

impl View {
    pub(crate) fn hull(&self) -> ReceiverHull {
        ReceiverHull::from_view(&self.camera, self.aspect, self.near_m, self.far_m)
    }

    /// Returns the point at fractions 0 to 1 of width, height and depth.
    pub(crate) fn point(&self, fractions: DVec3) -> DVec3 {
        let depth_m = self.near_m + (self.far_m - self.near_m) * fractions.z;
        let corner = self.camera.slice_corners_view(self.aspect, depth_m, depth_m)[3];
        let view =
            DVec3::new(corner.x * (2.0 * fractions.x - 1.0), corner.y * (2.0 * fractions.y - 1.0), -depth_m);
        self.camera.world_from_view.transform_point3(view)
    }

    pub(crate) fn contains(&self, point: DVec3) -> bool {
        let view = self.camera.world_from_view.inverse().transform_point3(point);
        let depth_m = -view.z;
        let corner = self.camera.slice_corners_view(self.aspect, depth_m, depth_m)[3];
        (self.near_m..=self.far_m).contains(&depth_m) && view.x.abs() <= corner.x && view.y.abs() <= corner.y
    }

    /// Returns the distance of the point from the slice, metres; 0 inside.
    pub(crate) fn distance(&self, point: DVec3) -> f64 {
        if self.contains(point) {
            return 0.0;
        }
        let corners = self.hull().corners().map(|corner| corner - point);
        let quads = [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]];
        let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [b, c, d]]);
        triangles.map(|t| distance_to_triangle(t.map(|i| corners[i]))).fold(f64::INFINITY, f64::min)
    }
}

/// Returns the distance of the origin from a triangle.
fn distance_to_triangle([a, b, c]: [DVec3; 3]) -> f64 {
    let segment = |from: DVec3, to: DVec3| {
        let along = to - from;
        let t = (-from.dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        (from + along * t).length()
    };
    let edges = segment(a, b).min(segment(b, c)).min(segment(c, a));
    let normal = (b - a).cross(c - a);
    let foot = normal * (normal.dot(a) / normal.length_squared());
    let side = |from: DVec3, to: DVec3| (to - from).cross(foot - from).dot(normal) >= 0.0;
    if side(a, b) && side(b, c) && side(c, a) { edges.min(foot.length()) } else { edges }
}

/// Returns the minimum of a convex function.
pub(crate) fn minimum(mut low: f64, mut high: f64, value: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..80 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if value(a) < value(b) { high = b } else { low = a }
    }
    value(low).min(value(high))
}

/// A small random number generator (splitmix64).
#[derive(Clone, Debug)]
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn below(&mut self, end: u64) -> u64 {
        self.bits() % end
    }

    /// Returns a number from 0 to 1.
    pub(crate) fn fraction(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Returns a number from 0 to 1, often one of the two.
    pub(crate) fn fraction_or_end(&mut self) -> f64 {
        match self.below(6) {
            0 => 0.0,
            1 => 1.0,
            _ => self.fraction(),
        }
    }

    pub(crate) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.fraction()
    }

    /// Returns a power of ten with a uniform exponent.
    pub(crate) fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.range(low, high))
    }

    pub(crate) fn cube(&mut self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| self.range(-1.0, 1.0)))
    }

    pub(crate) fn unit(&mut self) -> DVec3 {
        loop {
            let vector = self.cube();
            if (1e-3..1.0).contains(&vector.length()) {
                return vector.normalize();
            }
        }
    }

    /// Returns a point in a view, often on its boundary.
    pub(crate) fn visible(&mut self, view: &View) -> DVec3 {
        let fractions = DVec3::new(self.fraction_or_end(), self.fraction_or_end(), self.fraction_or_end());
        // Near ends are small: with uniform depths they would hardly be sampled.
        let depth = if self.below(2) == 0 { fractions.z } else { fractions.z * self.magnitude(-4.0, 0.0) };
        view.point(fractions.with_z(depth))
    }

    pub(crate) fn projection(&mut self, near_m: f64, far_m: f64) -> Projection {
        if self.below(5) == 0 {
            let (half_width, half_height) = (self.magnitude(-1.0, 3.0), self.magnitude(-1.0, 3.0));
            return Projection::Orthographic { half_width, half_height, near: near_m, far: far_m };
        }
        Projection::Perspective { fov_y: self.range(10.0, 150.0).to_radians(), near: near_m, far: None }
    }

    /// Returns a view of any kind, up to `distance_m` from the origin.
    pub(crate) fn view(&mut self, distance_m: f64) -> View {
        let far_m = self.magnitude(0.0, 4.0);
        let near_m = self.magnitude(-4.0, 1.0).min(far_m * self.range(0.01, 0.95));
        let projection = self.projection(near_m, far_m);
        let eye = self.cube() * distance_m;
        // Often along the axes, where faces are parallel to lights and boxes.
        let forward = match self.below(3) {
            0 => DVec3::AXES[self.below(3) as usize],
            _ => self.unit(),
        };
        let up = if self.below(2) == 0 { DVec3::Y } else { self.unit() };
        let camera = Camera::look_at(eye, eye + forward, up, projection);
        View { camera, aspect: self.magnitude(-0.5, 0.6), near_m, far_m }
    }

    /// Returns the direction to a light, often along an edge or a face of the view, or nearly so.
    pub(crate) fn light_direction(&mut self, view: &View) -> DVec3 {
        let hull = view.hull();
        let corner = |random: &mut Self| hull.corners()[random.below(8) as usize];
        let face = |random: &mut Self| hull.faces()[random.below(hull.faces().len() as u64) as usize].normal;
        let direction = match self.below(6) {
            0 => corner(self) - corner(self),
            1 => face(self),
            2 => face(self).cross(self.unit()),
            3 => view.camera.world_from_view.matrix3.col(self.below(3) as usize),
            _ => self.unit(),
        };
        let sign = if self.below(2) == 0 { 1.0 } else { -1.0 };
        let exact = (direction * sign).try_normalize().unwrap_or(DVec3::Y);
        let aside = if self.below(2) == 0 { 0.0 } else { self.magnitude(-9.0, -2.0) };
        (exact + self.unit() * aside).normalize()
    }

    /// Returns the rotation to light space for the direction towards the light.
    pub(crate) fn axes(&mut self, to_light: DVec3) -> DMat3 {
        let right = if self.below(2) == 0 { DVec3::Y.cross(to_light) } else { DVec3::ZERO };
        let right = right.try_normalize().unwrap_or_else(|| to_light.any_orthonormal_vector());
        DMat3::from_cols(right, to_light.cross(right), to_light).transpose()
    }
}

/// Seeds of scenes: a failure prints its seed.
pub(crate) fn randoms() -> impl Strategy<Value = Random> {
    any::<u64>().prop_map(Random).no_shrink()
}

/// Returns the number of cases of each property; `PROPTEST_CASES` raises it.
pub(crate) fn cases() -> u32 {
    500.max(ProptestConfig::default().cases)
}
