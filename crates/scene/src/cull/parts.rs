//! A volume's parts, and which of them are still in question further down a tree.

use crate::{Aabb, Plane};

use crate::cull::part::{ConeFrame, Part};
use crate::cull::{BoundingSphere, CullVolume};

#[cfg(test)]
mod tests;

/// A volume, ready for tests of many boxes.
pub(crate) struct Parts<'a> {
    sphere: Option<BoundingSphere>,
    cone: Option<ConeFrame>,
    planes: &'a [Plane],
}

/// Where a node lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Place {
    /// No box in it touches.
    Outside,
    /// Every box in it touches, if it is not empty.
    Inside,
    /// Each is to be tested, against what is not settled.
    Across(Settled),
}

/// The parts that a node lies within: they need no test below it. A bit each; parts from number 64 on have none and
/// are tested everywhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Settled(u64);

const SPHERE: u32 = 0;
const CONE: u32 = 1;
const FIRST_PLANE: u32 = 2;

impl<'a> Parts<'a> {
    pub(crate) fn new(volume: &'a CullVolume) -> Self {
        let cone = volume.cone.as_ref().map(ConeFrame::new);
        Self { sphere: volume.sphere, cone, planes: &volume.planes.planes }
    }

    /// Tells whether the box may touch all parts, given what is settled for a box around it.
    pub(crate) fn touch(&self, bounds: &Aabb, settled: Settled) -> bool {
        !bounds.is_empty()
            && self.sphere.iter().all(|sphere| settled.has(SPHERE) || sphere.touches(bounds))
            && self.cone.iter().all(|cone| settled.has(CONE) || cone.touches(bounds))
            && self.planes().all(|(number, plane)| settled.has(number) || plane.touches(bounds))
    }

    /// Tells where a node lies, given what is settled for the node above it.
    pub(crate) fn place(&self, bounds: &Aabb, settled: Settled) -> Place {
        if !self.touch(bounds, settled) {
            return Place::Outside;
        }
        let mut below = settled;
        let mut inside = true;
        let mut see = |number, holds| if holds { below.add(number) } else { inside = false };
        if let Some(sphere) = &self.sphere {
            see(SPHERE, settled.has(SPHERE) || sphere.holds(bounds));
        }
        if let Some(cone) = &self.cone {
            see(CONE, settled.has(CONE) || cone.holds(bounds));
        }
        for (number, plane) in self.planes() {
            see(number, settled.has(number) || plane.holds(bounds));
        }
        if inside { Place::Inside } else { Place::Across(below) }
    }

    fn planes(&self) -> impl Iterator<Item = (u32, &Plane)> {
        (FIRST_PLANE..).zip(self.planes)
    }
}

impl Settled {
    fn has(self, number: u32) -> bool {
        self.0 & Self::bit(number) != 0
    }

    fn add(&mut self, number: u32) {
        self.0 |= Self::bit(number);
    }

    fn bit(number: u32) -> u64 {
        1u64.checked_shl(number).unwrap_or(0)
    }
}
