//! A box against a cone, in the cone's own axes.

use crate::Aabb;
use glam::DVec3;

use super::{Part, furthest_corner, nearest_corner};
use crate::cull::Cone;

/// A cone, ready for tests of many boxes.
///
/// A box is taken as the intervals that it spans along the cone's axis and across it: the box around the box that
/// stands straight in the cone's axes. That one is tested exactly but for the cone's flat end. It is about as tight
/// as the sphere around the box, needs no square root, and is smaller for smaller boxes, which spheres are not.
pub(crate) struct ConeFrame {
    tip_world: DVec3,
    axis: DVec3,
    across: [DVec3; 2],
    sin: f64,
    cos: f64,
    length_m: f64,
}

impl ConeFrame {
    /// One copy for all callers, since a sine may differ from one compilation of it to the next.
    #[inline(never)]
    pub(crate) fn new(cone: &Cone) -> Self {
        let (right, up) = cone.axis.any_orthonormal_pair();
        let (sin, cos) = cone.half_angle.sin_cos();
        Self {
            tip_world: cone.tip_world,
            axis: cone.axis,
            across: [right, up],
            sin,
            cos,
            length_m: cone.length_m,
        }
    }

    /// Whether a point that far along the axis and that far from it (squared) is inside, the flat end aside.
    fn opens_to(&self, along: f64, across_squared: f64) -> bool {
        along >= 0.0 && across_squared * (self.cos * self.cos) <= (along * self.sin) * (along * self.sin)
    }

    fn span(&self, bounds: &Aabb, axis: DVec3) -> Span {
        let from_tip = Aabb { min: bounds.min - self.tip_world, max: bounds.max - self.tip_world };
        Span {
            low: axis.dot(nearest_corner(&from_tip, axis)),
            high: axis.dot(furthest_corner(&from_tip, axis)),
        }
    }
}

impl Part for ConeFrame {
    fn touches(&self, bounds: &Aabb) -> bool {
        let along = self.span(bounds, self.axis);
        let [x, y] = self.across.map(|axis| self.span(bounds, axis).nearest());
        along.low <= self.length_m && self.opens_to(along.high, x * x + y * y)
    }

    fn holds(&self, bounds: &Aabb) -> bool {
        let along = self.span(bounds, self.axis);
        let [x, y] = self.across.map(|axis| self.span(bounds, axis).farthest());
        along.high <= self.length_m && self.opens_to(along.low, x * x + y * y)
    }
}

/// Where a box lies along an axis through the tip, metres from the tip.
struct Span {
    low: f64,
    high: f64,
}

impl Span {
    /// The least distance from the tip.
    fn nearest(&self) -> f64 {
        self.low.max(-self.high).max(0.0)
    }

    /// The largest distance from the tip.
    fn farthest(&self) -> f64 {
        self.high.max(-self.low)
    }
}
