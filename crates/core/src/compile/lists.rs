//! Many short lists in one array.

/// For each key a list, all in one array.
pub(super) struct Lists<T> {
    /// Where the list of each key begins; one more for the end.
    starts: Vec<u32>,
    items: Vec<T>,
}

impl<T: Copy> Lists<T> {
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

    /// The items of a key, in the order in which they came.
    pub(super) fn of(&self, key: usize) -> &[T] {
        &self.items[self.starts[key] as usize..self.starts[key + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::Lists;

    #[test]
    fn items_keep_their_order_within_a_key() {
        let items = [(2, 'a'), (0, 'b'), (2, 'c'), (3, 'd'), (0, 'e')];
        let lists = Lists::new(5, || items.into_iter());
        let found: Vec<String> = (0..5).map(|key| lists.of(key).iter().collect()).collect();
        assert_eq!(found, ["be", "", "ac", "d", ""]);
    }

    #[test]
    fn there_can_be_no_keys() {
        assert!(Lists::<u32>::new(0, std::iter::empty).items.is_empty());
    }
}
