//! Changes of static casters.

use std::collections::VecDeque;

use crate::bounds::Aabb;
use crate::cull::CullVolume;

/// The most changes that are remembered one by one.
const MAX_CHANGES: usize = 256;

/// Where static casters have changed, and in which version.
#[derive(Debug, Default)]
pub(super) struct StaticChanges {
    /// The version of the last change.
    version: u64,
    /// The version before which changes are forgotten.
    forgotten: u64,
    changes: VecDeque<(u64, Aabb)>,
}

impl StaticChanges {
    /// Adds a change within some bounds.
    pub(super) fn add(&mut self, version: u64, bounds: Aabb) {
        if bounds.is_empty() {
            return;
        }
        self.version = self.version.max(version);
        if self.changes.len() == MAX_CHANGES
            && let Some((oldest, _)) = self.changes.pop_front()
        {
            self.forgotten = oldest;
        }
        self.changes.push_back((version, bounds));
    }

    /// Returns the version of the last change.
    pub(super) fn version(&self) -> u64 {
        self.version
    }

    /// Appends the bounds of changes since a version, and returns whether none of them has been forgotten.
    pub(super) fn bounds_since(&self, version: u64, bounds: &mut Vec<Aabb>) -> bool {
        let later = self.changes.iter().rev().take_while(|(changed, _)| *changed > version);
        bounds.extend(later.map(|(_, bounds)| *bounds));
        version >= self.forgotten
    }

    /// Returns whether anything in the volume may have changed since a version.
    pub(super) fn since(&self, version: u64, volume: &CullVolume) -> bool {
        let later = self.changes.iter().rev().take_while(|(changed, _)| *changed > version);
        version < self.forgotten || later.into_iter().any(|(_, bounds)| volume.intersects(bounds))
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::cull::BoundingSphere;

    fn bounds_from(x: f64) -> Aabb {
        Aabb { min: DVec3::new(x, 0.0, 0.0), max: DVec3::new(x + 1.0, 1.0, 1.0) }
    }

    fn around(x: f64) -> CullVolume {
        let sphere = BoundingSphere { center_world: DVec3::X * x, radius_m: 2.0 };
        CullVolume { sphere: Some(sphere), ..CullVolume::default() }
    }

    #[test]
    fn a_change_counts_where_it_was_and_for_older_versions() {
        let mut changes = StaticChanges::default();
        changes.add(5, bounds_from(0.0));
        changes.add(7, bounds_from(10.0));
        changes.add(8, Aabb::EMPTY);
        assert_eq!(changes.version(), 7);
        assert!(changes.since(4, &around(0.0)) && !changes.since(5, &around(0.0)));
        assert!(changes.since(6, &around(10.0)) && !changes.since(7, &around(10.0)));
        assert!(!changes.since(0, &around(20.0)));
    }

    #[test]
    fn what_was_forgotten_may_have_been_anywhere() {
        let mut changes = StaticChanges::default();
        for version in 1..=MAX_CHANGES as u64 + 2 {
            changes.add(version, bounds_from(0.0));
        }
        assert!(changes.since(1, &around(20.0)));
        assert!(!changes.since(2, &around(20.0)));
    }
}
