//! Casters that a cascade does not need, as finer cascades cover everything that they darken.

use glam::DVec3;
use shadowgraph_scene::Aabb;

use super::light_space_view::LightSpaceView;
use super::supporting_planes::rounding_m;

/// The receivers that read a cascade or a finer one. Coordinates are in light space: x and y across the light, z
/// towards it, metres from the world's origin.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CoveredByFinerCascade {
    /// The receivers in a box.
    ///
    /// The box must be smaller than the area of the cascade's map by everything that can make a receiver read a
    /// coarser cascade: border, bias, the width of a blend.
    Box(Aabb),
    /// The receivers in a sphere, shrunk likewise.
    Sphere {
        /// The centre.
        center_light: DVec3,
        /// The radius, metres.
        radius_m: f64,
    },
    /// The receivers up to a view depth.
    Depth {
        /// The visible receivers beyond that depth (less the width of a blend).
        beyond: LightSpaceView,
    },
}

/// Finds the redundant casters of one cascade.
///
/// In a cascade's map, a caster darkens only the column below it: its bounds across the light, extended from its end
/// nearest to the light to infinity, and grown by the radius of the filter. The caster is redundant if no visible part
/// of that column remains outside the volumes that finer cascades cover. So it is kept for receivers
/// next to those volumes, and farther along the light than they extend.
#[derive(Clone, Copy, Debug)]
pub struct RedundantCasters<'a> {
    view: &'a LightSpaceView,
    finer: &'a [CoveredByFinerCascade],
    radius_m: f64,
}

impl<'a> RedundantCasters<'a> {
    /// Prepares the test for the cascade after `finer`, which begins with the finest. `view` holds all visible receivers.
    ///
    /// `radius_m` (metres, at least 0) is the radius around a receiver, across the light and along it, in which this
    /// cascade is read: the filter's radius and the offsets of the bias.
    ///
    /// Without finer cascades only casters that darken nothing visible are redundant.
    #[must_use]
    pub fn new(view: &'a LightSpaceView, finer: &'a [CoveredByFinerCascade], radius_m: f64) -> Self {
        Self { view, finer, radius_m: radius_m.max(0.0) }
    }

    /// Returns whether the caster with these bounds in light space is redundant. An empty box is.
    ///
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use shadowgraph_scene::Aabb;
    /// use shadowgraph_shadows::{ReceiverHull, CoveredByFinerCascade, RedundantCasters, LightSpaceView};
    /// let cube = |half: f64| Aabb { min: DVec3::splat(-half), max: DVec3::splat(half) };
    /// let view = LightSpaceView::new(&ReceiverHull::from_box(&cube(10.0)), DMat3::IDENTITY);
    /// let finer = [CoveredByFinerCascade::Box(Aabb { min: DVec3::splat(-5.0), max: DVec3::new(5.0, 5.0, 20.0) })];
    /// let coarser = RedundantCasters::new(&view, &finer, 0.1);
    /// // What is visible below -5 reads the coarser cascade.
    /// assert!(!coarser.is_redundant(&cube(1.0)));
    /// let finer = [CoveredByFinerCascade::Box(Aabb { min: DVec3::new(-5.0, -5.0, -20.0), max: DVec3::splat(5.0) })];
    /// let coarser = RedundantCasters::new(&view, &finer, 0.1);
    /// assert!(coarser.is_redundant(&cube(1.0)));
    /// assert!(!coarser.is_redundant(&cube(4.95)));
    /// ```
    #[must_use]
    pub fn is_redundant(&self, caster_light: &Aabb) -> bool {
        let Aabb { min, max } = *caster_light;
        let column = Aabb {
            min: (min.truncate() - self.radius_m).extend(f64::NEG_INFINITY),
            max: max + self.radius_m,
        };
        is_covered(&column, self.view, self.finer)
    }
}

/// Returns whether all visible receivers in the box are covered.
fn is_covered(piece: &Aabb, view: &LightSpaceView, finer: &[CoveredByFinerCascade]) -> bool {
    view.visible_part(piece).is_none_or(|part| is_part_covered(&part, view, finer))
}

/// Returns the same for a box that contains visible receivers.
fn is_part_covered(part: &Aabb, view: &LightSpaceView, finer: &[CoveredByFinerCascade]) -> bool {
    // The coarsest cascade covers the most.
    let Some((covered, finer)) = finer.split_last() else { return false };
    let inner = match covered {
        CoveredByFinerCascade::Depth { beyond } => return is_covered(part, beyond, finer),
        CoveredByFinerCascade::Box(covered) => common(part, covered),
        CoveredByFinerCascade::Sphere { center_light, radius_m } => inscribed(part, *center_light, *radius_m),
    };
    match inner {
        Some(inner) => outside(part, &inner).all(|piece| is_covered(&piece, view, finer)),
        None => is_part_covered(part, view, finer),
    }
}

/// Returns the intersection of two boxes; `None` if it is empty, or a side of `b` is not a number.
fn common(a: &Aabb, b: &Aabb) -> Option<Aabb> {
    let both = Aabb { min: a.min.max(b.min), max: a.max.min(b.max) };
    (!both.is_empty()).then_some(both)
}

/// Returns the largest part of the box, over its whole width and height, that lies in the sphere.
fn inscribed(part: &Aabb, center: DVec3, radius_m: f64) -> Option<Aabb> {
    let radius_m = radius_m - rounding_m(&[part.min, part.max, center]);
    let farthest = (part.min - center).abs().max((part.max - center).abs()).truncate();
    let half_m = (radius_m * radius_m - farthest.length_squared()).max(0.0).sqrt();
    let sphere = Aabb {
        min: part.min.truncate().extend(center.z - half_m),
        max: part.max.truncate().extend(center.z + half_m),
    };
    if radius_m > 0.0 && half_m > 0.0 { common(part, &sphere) } else { None }
}

/// Splits the box without `inner`, which lies in it, into up to six boxes.
fn outside(part: &Aabb, inner: &Aabb) -> impl Iterator<Item = Aabb> {
    let mut rest = *part;
    let mut pieces = [None; 6];
    // Along the light first: usually the column passes through the whole box, and is as wide as the rest.
    for (axis, pieces) in [2, 0, 1].into_iter().zip(pieces.chunks_exact_mut(2)) {
        if rest.min[axis] < inner.min[axis] {
            let mut piece = rest;
            piece.max[axis] = inner.min[axis];
            rest.min[axis] = inner.min[axis];
            pieces[0] = Some(piece);
        }
        if inner.max[axis] < rest.max[axis] {
            let mut piece = rest;
            piece.min[axis] = inner.max[axis];
            rest.max[axis] = inner.max[axis];
            pieces[1] = Some(piece);
        }
    }
    pieces.into_iter().flatten()
}

#[cfg(test)]
mod tests;
