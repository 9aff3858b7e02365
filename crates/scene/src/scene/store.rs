//! Values by stable keys, with the number of users of each and a log of what changed.

use slotmap::{Key, SlotMap};

/// A value, and what the store knows of it.
#[derive(Clone, Debug)]
struct Entry<T> {
    value: T,
    /// The number of other values that refer to this one.
    users: u32,
    /// Whether the log has the key.
    logged: bool,
}

/// Values by key. Every edit logs its key once, until the log is taken.
#[derive(Clone, Debug)]
pub(super) struct Store<K: Key, T> {
    entries: SlotMap<K, Entry<T>>,
    log: Vec<K>,
}

impl<K: Key, T> Default for Store<K, T> {
    fn default() -> Self {
        Self { entries: SlotMap::with_key(), log: Vec::new() }
    }
}

impl<K: Key, T: PartialEq> PartialEq for Store<K, T> {
    /// Compares keys and values, not the log.
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().eq(other.iter())
    }
}

impl<K: Key, T> Store<K, T> {
    pub(super) fn len(&self) -> usize {
        self.entries.len()
    }

    pub(super) fn get(&self, key: K) -> Option<&T> {
        self.entries.get(key).map(|entry| &entry.value)
    }

    pub(super) fn iter(&self) -> impl ExactSizeIterator<Item = (K, &T)> + Clone {
        self.entries.iter().map(|(key, entry)| (key, &entry.value))
    }

    pub(super) fn insert(&mut self, value: T) -> K {
        let key = self.entries.insert(Entry { value, users: 0, logged: true });
        self.log.push(key);
        key
    }

    /// Returns a value for a change, and logs its key.
    pub(super) fn edit(&mut self, key: K) -> Option<&mut T> {
        let entry = self.entries.get_mut(key)?;
        if !std::mem::replace(&mut entry.logged, true) {
            self.log.push(key);
        }
        Some(&mut entry.value)
    }

    pub(super) fn remove(&mut self, key: K) -> Option<T> {
        let entry = self.entries.remove(key)?;
        if !entry.logged {
            self.log.push(key);
        }
        Some(entry.value)
    }

    /// Returns the number of values that refer to this one; 0 if there is no such value.
    pub(super) fn users(&self, key: K) -> u32 {
        self.entries.get(key).map_or(0, |entry| entry.users)
    }

    pub(super) fn add_user(&mut self, key: K) {
        self.entries.get_mut(key).into_iter().for_each(|entry| entry.users += 1);
    }

    pub(super) fn remove_user(&mut self, key: K) {
        self.entries.get_mut(key).into_iter().for_each(|entry| entry.users -= 1);
    }

    /// Takes the keys of inserted, edited and removed values, in the order of their first edit.
    pub(super) fn take_log(&mut self) -> Vec<K> {
        for key in &self.log {
            self.entries.get_mut(*key).into_iter().for_each(|entry| entry.logged = false);
        }
        std::mem::take(&mut self.log)
    }

    /// Logs keys again that were taken.
    pub(super) fn restore_log(&mut self, taken: Vec<K>) {
        for key in taken {
            let logged = match self.entries.get_mut(key) {
                Some(entry) => std::mem::replace(&mut entry.logged, true),
                None => self.log.contains(&key),
            };
            if !logged {
                self.log.push(key);
            }
        }
    }
}
