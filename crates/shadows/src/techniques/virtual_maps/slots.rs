//! The projections of a view that have entries in its page table, from frame to frame.

use super::projections::{DIRECTIONAL_ENTRIES, LOCAL_ENTRIES, Projection};

/// The projections by their index in the shaders' list. A projection keeps its index and its version for as long as it is used without a
/// change.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Slots {
    slots: Vec<Slot>,
    /// The last version that was given.
    versions: u32,
}

/// The projections of a light, which are next to each other.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    pub(super) projections: Vec<Projection>,
    /// Whether pages of an equal group of the previous frame are kept.
    pub(super) keeps: bool,
}

/// A place for a projection.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slot {
    first_entry: u32,
    entries: u32,
    /// The projection and its version.
    used: Option<(Projection, u32)>,
}

/// A projection of a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Placed {
    pub(super) projection: Projection,
    pub(super) first_entry: u32,
    pub(super) version: u32,
}

impl Slots {
    /// Returns the slots of the next frame, with these projections, and the index of the first of each group. Nothing else stays.
    pub(super) fn next(&self, groups: &[Group]) -> (Self, Vec<u32>) {
        let mut next = Self { versions: self.versions, slots: self.slots.clone() };
        next.slots.iter_mut().for_each(|slot| slot.used = None);
        let mut firsts = vec![None; groups.len()];
        for (first, group) in firsts.iter_mut().zip(groups) {
            *first = self.find(&group.projections, &next).filter(|_| group.keeps);
            if let Some(first) = *first {
                let range = first..first + group.projections.len();
                next.slots[range.clone()].copy_from_slice(&self.slots[range]);
            }
        }
        let firsts = firsts.into_iter().zip(groups);
        let firsts = firsts
            .map(|(first, group)| first.unwrap_or_else(|| next.insert(&group.projections)) as u32)
            .collect();
        (next, firsts)
    }

    /// Returns the projections by index; `None` for unused ones.
    pub(super) fn placed(&self) -> impl Iterator<Item = Option<Placed>> {
        self.slots.iter().map(|slot| {
            slot.used.map(|(projection, version)| Placed {
                projection,
                first_entry: slot.first_entry,
                version,
            })
        })
    }

    /// Returns the number of entries of the table.
    pub(super) fn entry_count(&self) -> u32 {
        self.slots.last().map_or(0, |slot| slot.first_entry + slot.entries)
    }

    /// Returns where a group was in the previous frame, if `next` has not yet used these slots.
    fn find(&self, group: &[Projection], next: &Self) -> Option<usize> {
        let is_same = |first: &usize| {
            let slots = self.slots[*first..].iter().zip(group);
            slots.into_iter().all(|(slot, projection)| slot.used.map(|(used, _)| used) == Some(*projection))
        };
        (0..self.slots.len()).filter(|&first| next.is_free(first, group)).find(is_same)
    }

    fn is_free(&self, first: usize, group: &[Projection]) -> bool {
        let slots = self.slots.get(first..first + group.len());
        slots.is_some_and(|slots| {
            slots
                .iter()
                .zip(group)
                .all(|(slot, projection)| slot.used.is_none() && slot.entries == entries(projection))
        })
    }

    /// Gives a group free slots, or new ones after the last, and returns the first.
    fn insert(&mut self, group: &[Projection]) -> usize {
        let free = (0..self.slots.len()).find(|&first| self.is_free(first, group));
        let first = free.unwrap_or_else(|| {
            let first = self.slots.len();
            for projection in group {
                let slot = Slot { first_entry: self.entry_count(), entries: entries(projection), used: None };
                self.slots.push(slot);
            }
            first
        });
        for (slot, projection) in self.slots[first..].iter_mut().zip(group) {
            self.versions += 1;
            slot.used = Some((*projection, self.versions));
        }
        first
    }
}

fn entries(projection: &Projection) -> u32 {
    match projection {
        Projection::Directional { .. } => DIRECTIONAL_ENTRIES,
        Projection::Local { .. } => LOCAL_ENTRIES,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3};

    use crate::spot::{SpotCone, SpotFit};

    fn sun(angle: f64) -> Group {
        let light_from_world = DMat3::from_rotation_x(angle);
        let projection = Projection::Directional { light_from_world, slope_bias_milli: 0 };
        Group { projections: vec![projection], keeps: true }
    }

    fn local(x: f64, faces: usize) -> Group {
        let position_world = DVec3::X * x;
        let cone = SpotCone { position_world, direction: DVec3::NEG_Z, half_angle: 0.5, range_m: 9.0 };
        let fit = SpotFit::new(cone, DMat3::IDENTITY, 0.1, 1024, 4.0);
        Group { projections: vec![Projection::Local { fit, slope_bias_milli: 0 }; faces], keeps: true }
    }

    fn versions(slots: &Slots, first: u32) -> u32 {
        slots.placed().nth(first as usize).flatten().map_or(0, |placed| placed.version)
    }

    #[test]
    fn a_projection_keeps_its_slot_and_its_version_until_it_changes() {
        let (first, at) = Slots::default().next(&[sun(0.1), local(1.0, 6), local(2.0, 1)]);
        assert_eq!(at, [0, 1, 7]);
        let (second, moved) = first.next(&[local(2.0, 1), sun(0.1), local(1.5, 6)]);
        assert_eq!(moved, [7, 0, 1]);
        assert_eq!([0, 7].map(|slot| versions(&second, slot)), [0, 7].map(|slot| versions(&first, slot)));
        assert!(versions(&second, 1) > versions(&first, 7));
        assert_eq!(first.entry_count(), second.entry_count());
    }

    #[test]
    fn slots_of_removed_lights_are_used_again_with_other_versions() {
        let (first, _) = Slots::default().next(&[sun(0.1), local(1.0, 1)]);
        let (second, at) = first.next(&[sun(0.2)]);
        assert_eq!((at[0], second.placed().flatten().count()), (0, 1));
        assert!(versions(&second, 0) > versions(&first, 1));
        // A spot light does not fit into the place of a directional light.
        let (third, at) = second.next(&[local(3.0, 1), local(4.0, 1)]);
        assert_eq!(at, [1, 2]);
        assert_eq!(third.entry_count(), DIRECTIONAL_ENTRIES + 2 * LOCAL_ENTRIES);
    }

    #[test]
    fn a_light_whose_pages_are_not_kept_has_another_version_in_each_frame() {
        let sun = Group { keeps: false, ..sun(0.1) };
        let (first, _) = Slots::default().next(&[sun.clone(), local(1.0, 1)]);
        let (second, at) = first.next(&[sun, local(1.0, 1)]);
        assert_eq!(at, [0, 1]);
        assert!(versions(&second, 0) > versions(&first, 0));
        assert_eq!(versions(&second, 1), versions(&first, 1));
    }

    #[test]
    fn equal_lights_have_a_slot_each() {
        let (first, at) = Slots::default().next(&[sun(0.1), sun(0.1)]);
        assert_eq!(at, [0, 1]);
        let (second, at) = first.next(&[sun(0.1), sun(0.1)]);
        assert_eq!(at, [0, 1]);
        assert_eq!(first, second);
    }
}
