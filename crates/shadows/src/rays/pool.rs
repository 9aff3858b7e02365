//! The elements of one buffer, and which of them have changed since they were last uploaded.

use std::ops::Range;

use fixedbitset::FixedBitSet;
use range_alloc::RangeAllocator;

/// Changed elements with at most this many unchanged ones between them are uploaded together.
const LARGEST_GAP: usize = 8;

/// Elements of a buffer in ranges that are allocated, freed and reused.
pub(crate) struct Pool<T> {
    elements: Vec<T>,
    ranges: RangeAllocator<u32>,
    changed: FixedBitSet,
}

impl<T: Copy + Default + PartialEq> Pool<T> {
    /// Creates a pool of at most `limit` elements.
    pub(crate) fn new(limit: u32) -> Self {
        Self { elements: Vec::new(), ranges: RangeAllocator::new(0..limit), changed: FixedBitSet::new() }
    }

    /// Stores elements next to each other; `None` if the pool is full.
    pub(crate) fn insert(&mut self, elements: &[T]) -> Option<Range<u32>> {
        if elements.is_empty() {
            return Some(0..0);
        }
        let range = self.ranges.allocate_range(u32::try_from(elements.len()).ok()?).ok()?;
        let end = range.end as usize;
        if self.elements.len() < end {
            self.elements.resize(end, T::default());
            self.changed.grow(end);
        }
        self.write(range.start, elements);
        Some(range)
    }

    /// Frees a range, or a part of one.
    pub(crate) fn remove(&mut self, range: Range<u32>) {
        if !range.is_empty() {
            self.ranges.free_range(range);
        }
    }

    /// Overwrites elements from `first` on; equal ones do not count as changed.
    pub(crate) fn write(&mut self, first: u32, elements: &[T]) {
        for (index, &element) in (first as usize..).zip(elements) {
            if let Some(old) = self.elements.get_mut(index).filter(|old| **old != element) {
                *old = element;
                self.changed.insert(index);
            }
        }
    }

    /// Overwrites one element.
    pub(crate) fn set(&mut self, index: u32, element: T) {
        self.write(index, &[element]);
    }

    /// Returns an element; the default if there is none.
    pub(crate) fn get(&self, index: u32) -> T {
        self.elements.get(index as usize).copied().unwrap_or_default()
    }

    /// Returns the elements of a range.
    pub(crate) fn slice(&self, range: Range<u32>) -> &[T] {
        self.elements.get(range.start as usize..range.end as usize).unwrap_or_default()
    }

    /// Returns all elements, freed ones too.
    pub(crate) fn elements(&self) -> &[T] {
        &self.elements
    }

    /// Returns the ranges of changed elements, ascending, and forgets them. New elements that equal what was there (or the default) are
    /// not among them: buffers begin with zeros.
    pub(crate) fn take_changed(&mut self) -> Vec<Range<usize>> {
        let mut ranges: Vec<Range<usize>> = Vec::new();
        for index in self.changed.ones() {
            match ranges.last_mut() {
                Some(last) if index - last.end <= LARGEST_GAP => last.end = index + 1,
                _ => ranges.push(index..index + 1),
            }
        }
        self.changed.clear();
        ranges
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn freed_ranges_are_reused_and_a_full_pool_refuses() {
        let mut pool = Pool::new(8);
        let [a, b] = [[1; 3], [2; 3]].map(|elements| pool.insert(&elements).unwrap());
        assert_eq!((a.clone(), b.clone()), (0..3, 3..6));
        assert_eq!(pool.insert(&[3; 3]), None);
        pool.remove(a.start..a.start + 2);
        assert_eq!(pool.insert(&[4; 2]), Some(0..2));
        assert_eq!(pool.insert(&[]), Some(0..0));
        assert_eq!(pool.elements(), [4, 4, 1, 2, 2, 2]);
        assert_eq!((pool.slice(b), pool.get(9)), (&[2; 3][..], 0));
    }

    #[test]
    fn only_changed_elements_are_returned_and_near_ones_together() {
        let mut pool = Pool::new(100);
        pool.insert(&[1; 60]);
        assert_eq!(pool.take_changed().first(), Some(&(0..60)));
        pool.set(1, 2);
        pool.write(8, &[1, 3]);
        pool.set(40, 1);
        pool.set(50, 7);
        assert_eq!(pool.take_changed(), vec![1..10, 50..51]);
        assert!(pool.take_changed().is_empty());
    }
}
