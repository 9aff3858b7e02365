//! Sorting of distinct numbers without extra memory.

/// Below one number per this many possible ones, comparing is faster than scanning a bit for each possible number.
const SPARSE: usize = 256;

/// Sorts the numbers from index `start` on. They must be distinct and below `end`.
///
/// Many numbers are sorted by setting a bit for each in words appended to the list, and reading the bits back in order.
pub(crate) fn sort_distinct(numbers: &mut Vec<u32>, start: usize, end: usize) {
    let count = numbers.len() - start;
    if count <= end / SPARSE {
        return numbers[start..].sort_unstable();
    }
    numbers.resize(numbers.len() + end.div_ceil(32), 0);
    let (numbers_in, words) = numbers[start..].split_at_mut(count);
    for &number in &*numbers_in {
        words[number as usize / 32] |= 1 << (number % 32);
    }
    let mut sorted = numbers_in.iter_mut();
    for (first, word) in (0u32..).step_by(32).zip(words) {
        while *word != 0
            && let Some(slot) = sorted.next()
        {
            *slot = first + word.trailing_zeros();
            *word &= *word - 1;
        }
    }
    numbers.truncate(start + count);
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn numbers_from_the_start_are_sorted_and_those_before_are_kept(
            numbers in prop::collection::btree_set(0..5000u32, 0..400).prop_map(Vec::from_iter).prop_shuffle(),
            before in prop::collection::vec(any::<u32>(), 0..5),
            spare in 0..100usize,
        ) {
            let end = numbers.iter().max().map_or(0, |&max| max as usize + 1) + spare;
            let mut expected = numbers.clone();
            expected.sort_unstable();
            let mut list = [before.clone(), numbers].concat();
            sort_distinct(&mut list, before.len(), end);
            prop_assert_eq!(list, [before, expected].concat());
        }
    }

    #[test]
    fn all_numbers_and_the_last_one_are_sorted() {
        let mut all: Vec<u32> = (0..64).rev().collect();
        sort_distinct(&mut all, 0, 64);
        assert_eq!(all, (0..64).collect::<Vec<_>>());
        let mut few = vec![10_000, 3];
        sort_distinct(&mut few, 0, 10_001);
        assert_eq!(few, [3, 10_000]);
    }
}
