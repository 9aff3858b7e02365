//! Numbers of keys.

use slotmap::{Key, SecondaryMap};

/// A number for each key, from 0 on; those of removed keys are used again.
#[derive(Clone, Debug)]
pub(super) struct Numbers<K: Key> {
    numbers: SecondaryMap<K, u32>,
    /// Freed numbers.
    free: Vec<u32>,
    /// The number of numbers, with the free ones.
    count: u32,
}

impl<K: Key> Default for Numbers<K> {
    fn default() -> Self {
        Self { numbers: SecondaryMap::new(), free: Vec::new(), count: 0 }
    }
}

impl<K: Key> Numbers<K> {
    pub(super) fn get(&self, key: K) -> Option<u32> {
        self.numbers.get(key).copied()
    }

    /// Returns the number of a key, which gets one if it has none.
    pub(super) fn insert(&mut self, key: K) -> u32 {
        if let Some(number) = self.get(key) {
            return number;
        }
        let number = self.free.pop().unwrap_or_else(|| {
            self.count += 1;
            self.count - 1
        });
        self.numbers.insert(key, number);
        number
    }

    /// Frees the number of a key, and returns it.
    pub(super) fn remove(&mut self, key: K) -> Option<u32> {
        let number = self.numbers.remove(key)?;
        self.free.push(number);
        Some(number)
    }
}

#[cfg(test)]
mod tests {
    use slotmap::SlotMap;

    use super::*;

    #[test]
    fn numbers_are_dense_and_used_again() {
        let mut keys = SlotMap::new();
        let mut numbers = Numbers::default();
        let first: Vec<slotmap::DefaultKey> = (0..3).map(|_| keys.insert(())).collect();
        assert_eq!(first.iter().map(|&key| numbers.insert(key)).collect::<Vec<_>>(), [0, 1, 2]);
        assert_eq!((numbers.insert(first[2]), numbers.get(first[1])), (2, Some(1)));
        assert_eq!((numbers.remove(first[1]), numbers.remove(first[1])), (Some(1), None));
        keys.remove(first[1]);
        let next = keys.insert(());
        assert_eq!((numbers.insert(next), numbers.get(first[1])), (1, None));
    }
}
