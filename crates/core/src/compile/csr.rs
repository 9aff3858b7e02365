//! Many short lists in one array.

/// For each key a list, all in one array.
pub(super) struct Csr<T> {
    /// Where the list of each key begins; one more for the end.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy> Csr<T> {
    /// Sorts items into the lists of their keys, which are below `keys`, and keeps their order. Goes through the
    /// items twice.
    pub(super) fn new<I: Iterator<Item = (usize, T)>>(keys: usize, items: impl Fn() -> I) -> Self {
        // Moved on by one, so that each start is moved to the list's end, which is the next start, by filling it.
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

    /// No lists yet, and room for these.
    pub(super) fn with_capacity(keys: usize, items: usize) -> Self {
        let mut starts = Vec::with_capacity(keys + 1);
        starts.push(0);
        Self { starts, items: Vec::with_capacity(items) }
    }

    /// Ends the list that is being filled, and leaves those up to `key`, which comes next, empty.
    pub(super) fn skip_to(&mut self, key: usize) {
        self.starts.resize(key + 1, self.items.len() as u32);
    }

    /// Adds to the list that is being filled.
    pub(super) fn push(&mut self, item: T) {
        self.items.push(item);
    }

    /// Where the items of a key begin and end among all items.
    pub(super) fn range(&self, key: usize) -> (u32, u32) {
        (self.starts[key], self.starts[key + 1])
    }

    /// All items, list after list.
    pub(super) fn into_items(self) -> Vec<T> {
        self.items
    }

    /// The items of a key, in the order in which they came.
    pub(super) fn of(&self, key: usize) -> &[T] {
        let (start, end) = self.range(key);
        &self.items[start as usize..end as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::Csr;

    #[test]
    fn items_keep_their_order_within_a_key() {
        let items = [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd'), (0, 'e')];
        let lists = Csr::new(5, || items.into_iter());
        let found: Vec<String> = (0..5).map(|key| lists.of(key).iter().collect()).collect();
        assert_eq!(found, ["be", "", "ac", "d", ""]);
    }

    #[test]
    fn lists_are_filled_one_after_the_other() {
        let mut lists = Csr::with_capacity(4, 3);
        for (key, items) in [(1, "ab"), (3, "c")] {
            lists.skip_to(key);
            items.chars().for_each(|item| lists.push(item));
        }
        lists.skip_to(5);
        let found: Vec<String> = (0..5).map(|key| lists.of(key).iter().collect()).collect();
        assert_eq!(found, ["", "ab", "", "c", ""]);
    }

    #[test]
    fn there_can_be_no_keys() {
        assert!(Csr::<u32>::new(0, std::iter::empty).items.is_empty());
    }
}
