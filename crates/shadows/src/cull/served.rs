//! Which casters a cascade does without, as finer ones serve all that they darken.

use glam::DVec3;
use shadowgraph_scene::Aabb;

use super::LightSpaceView;
use super::supports::rounding_m;

/// Which receivers read a cascade, or one finer. Coordinates are on the light's axes: x and y across the light, z
/// towards it, metres from the world's origin.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CoveredByFinerCascade {
    /// Those in the box.
    ///
    /// It must already be smaller than what the cascade's map covers by whatever can send a receiver inside to a
    /// coarser one: border, bias, the width of a blend.
    Box(Aabb),
    /// Those in the sphere, likewise shrunk.
    Sphere {
        /// Its centre.
        center_light: DVec3,
        /// Its radius, metres.
        radius_m: f64,
    },
    /// Those up to a view depth.
    Depth {
        /// What is left of the visible receivers from that depth (less the width of a blend) on.
        beyond: LightSpaceView,
    },
}

/// Tells which casters can be left out of one cascade.
///
/// A caster darkens, as a cascade sees it, only what lies in the column below it: its bounds across the light, and
/// from its end nearest to the light on, all grown by the reach of the filter. It can be left out if no visible part
/// of that column is left once the spaces that finer cascades serve are taken away. So it is kept for receivers
/// beside those spaces, and further along the light than they reach.
#[derive(Clone, Copy, Debug)]
pub struct RedundantCasters<'a> {
    view: &'a LightSpaceView,
    finer: &'a [CoveredByFinerCascade],
    reach_m: f64,
}

impl<'a> RedundantCasters<'a> {
    /// Asks for the cascade after `finer`, the finest first. `view` is all that is visible.
    ///
    /// `reach_m` (metres, at least 0) is how far from a receiver, across the light and along it, this cascade is
    /// read for it: the filter's radius and the offsets of the bias.
    ///
    /// Without finer cascades only casters that darken nothing visible are left out.
    #[must_use]
    pub fn new(view: &'a LightSpaceView, finer: &'a [CoveredByFinerCascade], reach_m: f64) -> Self {
        Self { view, finer, reach_m: reach_m.max(0.0) }
    }

    /// Tells whether the caster with these bounds on the light's axes can be left out. An empty box can.
    ///
    /// ```
    /// use glam::{DMat3, DVec3};
    /// use shadowgraph_scene::Aabb;
    /// use shadowgraph_shadows::{ReceiverHull, CoveredByFinerCascade, RedundantCasters, LightSpaceView};
    /// let cube = |half: f64| Aabb { min: DVec3::splat(-half), max: DVec3::splat(half) };
    /// let view = LightSpaceView::new(&ReceiverHull::of_box(&cube(10.0)), DMat3::IDENTITY);
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
        let column =
            Aabb { min: (min.truncate() - self.reach_m).extend(f64::NEG_INFINITY), max: max + self.reach_m };
        all_served(&column, self.view, self.finer)
    }
}

/// Whether all that is visible in the box is served.
fn all_served(piece: &Aabb, view: &LightSpaceView, finer: &[CoveredByFinerCascade]) -> bool {
    view.visible_part(piece).is_none_or(|part| part_served(&part, view, finer))
}

/// The same for a box that has been found to hold something visible.
fn part_served(part: &Aabb, view: &LightSpaceView, finer: &[CoveredByFinerCascade]) -> bool {
    // The coarsest of them takes away the most.
    let Some((served, finer)) = finer.split_last() else { return false };
    let inner = match served {
        CoveredByFinerCascade::Depth { beyond } => return all_served(part, beyond, finer),
        CoveredByFinerCascade::Box(served) => common(part, served),
        CoveredByFinerCascade::Sphere { center_light, radius_m } => inscribed(part, *center_light, *radius_m),
    };
    match inner {
        Some(inner) => outside(part, &inner).all(|piece| all_served(&piece, view, finer)),
        None => part_served(part, view, finer),
    }
}

/// The space in both boxes; `None` where there is none, or a side of `b` is not a number.
fn common(a: &Aabb, b: &Aabb) -> Option<Aabb> {
    let both = Aabb { min: a.min.max(b.min), max: a.max.min(b.max) };
    (!both.is_empty()).then_some(both)
}

/// The part of the box, over its whole width and height, that lies in the sphere.
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

/// The box without `inner`, which lies in it, cut into up to six boxes.
fn outside(part: &Aabb, inner: &Aabb) -> impl Iterator<Item = Aabb> {
    let mut rest = *part;
    let mut pieces = [None; 6];
    // Along the light first: mostly the column goes through, and is as wide as what is left.
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
