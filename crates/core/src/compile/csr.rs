//! Compressed sparse rows: many short lists in one array.

/// A list for each key, all in one array.
pub(super) struct Csr<T> {
    /// Start of each row, and the end of the last.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy> Csr<T> {
    /// Sorts items into the rows of their keys, which are below `keys`, and keeps their order. Iterates twice over the
    /// items.
    pub(super) fn new<I: Iterator<Item = (usize, T)>>(keys: usize, items: impl Fn() -> I) -> Self {
        // Shifted by one, so that filling a row moves its start to its end, which is the start of the next row.
        let mut starts = vec![0; keys + 2];
        for (key, _) in items() {
            starts[key + 2] += 1;
        }
        for key in 2..starts.len() {
            starts[key] += starts[key - 1];
        }
        let mut sorted = match items().next() {
            Some((_, any)) => vec![any; starts[keys + 1] as usize],
            None => Vec::new(),
        };
        for (key, item) in items() {
            let at = &mut starts[key + 1];
            sorted[*at as usize] = item;
            *at += 1;
        }
        Self { starts, items: sorted }
    }

    /// Creates an empty value with capacity for these numbers of keys and items.
    pub(super) fn with_capacity(keys: usize, items: usize) -> Self {
        let mut starts = Vec::with_capacity(keys + 1);
        starts.push(0);
        Self { starts, items: Vec::with_capacity(items) }
    }

    /// Ends the current row and starts that of `key`; the rows between are empty.
    pub(super) fn skip_to(&mut self, key: usize) {
        self.starts.resize(key + 1, self.items.len() as u32);
    }

    /// Adds an item to the current row.
    pub(super) fn push(&mut self, item: T) {
        self.items.push(item);
    }

    /// Returns the range of the items of a key among all items.
    pub(super) fn range(&self, key: usize) -> (u32, u32) {
        (self.starts[key], self.starts[key + 1])
    }

    /// Returns all items, row after row.
    pub(super) fn into_items(self) -> Vec<T> {
        self.items
    }

    /// Returns the items of a key, in the order in which they were added.
    pub(super) fn row(&self, key: usize) -> &[T] {
        let (start, end) = self.range(key);
        &self.items[start as usize..end as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::Csr;

    #[test]
    fn items_of_a_key_keep_their_order() {
        let items = [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd'), (0, 'e')];
        let rows = Csr::new(5, || items.into_iter());
        let found: Vec<String> = (0..5).map(|key| rows.row(key).iter().collect()).collect();
        assert_eq!(found, ["be", "", "ac", "d", ""]);
    }

    #[test]
    fn rows_are_filled_in_order() {
        let mut rows = Csr::with_capacity(4, 3);
        for (key, items) in [(1, "ab"), (3, "c")] {
            rows.skip_to(key);
            items.chars().for_each(|item| rows.push(item));
        }
        rows.skip_to(5);
        let found: Vec<String> = (0..5).map(|key| rows.row(key).iter().collect()).collect();
        assert_eq!(found, ["", "ab", "", "c", ""]);
    }

    #[test]
    fn zero_keys_are_allowed() {
        assert!(Csr::<u32>::new(0, std::iter::empty).items.is_empty());
    }
}
