//! A ray, and its intersection with a triangle.

use glam::{Vec3, Vec3Swizzles};

/// A segment of a ray: the points `origin + t * direction`, with `t` from `min_m` up to but not including
/// `max_m`.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    origin: Vec3,
    direction: Vec3,
    min_m: f32,
    max_m: f32,
    along: Along,
    /// The shear that maps the direction to (0, 0, 1): x and y per z, and z per metre.
    shear: Vec3,
}

/// The axis of a direction's largest component.
#[derive(Clone, Copy, Debug)]
enum Along {
    X,
    Y,
    Z,
}

/// The intersection of a ray and a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// Distance along the ray, metres.
    pub distance_m: f32,
    /// Barycentric weights of the corners: each from 0 to 1, with a sum of 1.
    pub weights: Vec3,
}

impl Ray {
    /// Creates a ray. `direction` has unit length, so that `min_m` and `max_m` are metres; `max_m` can be infinite.
    #[must_use]
    pub fn new(origin: Vec3, direction: Vec3, min_m: f32, max_m: f32) -> Self {
        let size = direction.abs();
        let along = if size.x >= size.y && size.x >= size.z {
            Along::X
        } else if size.y >= size.z {
            Along::Y
        } else {
            Along::Z
        };
        let turned = along.turned(direction);
        let shear = Vec3::new(turned.x / turned.z, turned.y / turned.z, 1.0 / turned.z);
        Self { origin, direction, min_m, max_m, along, shear }
    }

    /// Returns the intersection with a triangle, from either side.
    ///
    /// This is the test of Woop, Benthin and Wald (*Watertight Ray/Triangle Intersection*, JCGT 2013): the
    /// triangle is sheared so that the ray runs along z, and the ray is inside if it lies on the same side of
    /// all three edges. Both triangles at an edge compute the same side of it to the bit, and a ray on the edge
    /// meets both.
    #[must_use]
    pub fn hit(&self, corners: [Vec3; 3]) -> Option<TriangleHit> {
        let [a, b, c] = corners.map(|corner| self.sheared(corner));
        let areas = Vec3::new(side(c, b), side(a, c), side(b, a));
        if areas.min_element() < 0.0 && areas.max_element() > 0.0 {
            return None;
        }
        let area = areas.x + areas.y + areas.z;
        if area == 0.0 {
            return None;
        }
        let weights = areas / area;
        let distance_m = weights.x * a.z + weights.y * b.z + weights.z * c.z;
        let inside = distance_m >= self.min_m && distance_m < self.max_m;
        inside.then_some(TriangleHit { distance_m, weights })
    }

    /// Returns the point in ray space: x and y across, z along the ray, metres.
    fn sheared(&self, point: Vec3) -> Vec3 {
        let p = self.along.turned(point - self.origin);
        Vec3::new(p.x - self.shear.x * p.z, p.y - self.shear.y * p.z, self.shear.z * p.z)
    }

    /// Returns the point that it starts from.
    pub(crate) fn origin(&self) -> Vec3 {
        self.origin
    }

    /// Returns its direction.
    pub(crate) fn direction(&self) -> Vec3 {
        self.direction
    }

    /// Returns its end, metres.
    pub(crate) fn max_m(&self) -> f32 {
        self.max_m
    }
}

impl Along {
    /// Returns the point with this axis as z, with the axes in the same cyclic order.
    fn turned(self, p: Vec3) -> Vec3 {
        match self {
            Self::X => p.yzx(),
            Self::Y => p.zxy(),
            Self::Z => p,
        }
    }
}

/// Returns twice the signed area of the triangle of the ray, `p` and `q`; with `p` and
/// `q` swapped exactly the negative. The numbers are split into halves of 12 bits, whose products f32 holds
/// exactly, so the error is 2⁻³⁶ of |p| |q| instead of 2⁻²⁴, which long thin triangles need. It does not
/// depend on whether the machine fuses products and sums.
fn side(p: Vec3, q: Vec3) -> f32 {
    let [(px, px_low), (py, py_low)] = [halves(p.x), halves(p.y)];
    let [(qx, qx_low), (qy, qy_low)] = [halves(q.x), halves(q.y)];
    let cross_terms = (px * qy_low - py * qx_low) + (px_low * qy - py_low * qx);
    (px * qy - py * qx) + (cross_terms + (px_low * qy_low - py_low * qx_low))
}

/// Splits a number into a sum of two, each of 12 bits.
fn halves(x: f32) -> (f32, f32) {
    let high = f32::from_bits(x.to_bits() & 0xffff_f000);
    (high, x - high)
}
