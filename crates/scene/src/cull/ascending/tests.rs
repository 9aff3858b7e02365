use proptest::prelude::*;

use super::*;

proptest! {
    #[test]
    fn numbers_are_sorted_and_those_before_are_left(
        numbers in prop::collection::btree_set(0..5000u32, 0..400).prop_map(Vec::from_iter).prop_shuffle(),
        before in prop::collection::vec(any::<u32>(), 0..5),
        spare in 0..100usize,
    ) {
        let end = numbers.iter().max().map_or(0, |&most| most as usize + 1) + spare;
        let mut expected = numbers.clone();
        expected.sort_unstable();
        let mut list = [before.clone(), numbers].concat();
        sort(&mut list, before.len(), end);
        prop_assert_eq!(list, [before, expected].concat());
    }
}

#[test]
fn all_numbers_and_the_last_one_are_sorted() {
    let mut all: Vec<u32> = (0..64).rev().collect();
    sort(&mut all, 0, 64);
    assert_eq!(all, (0..64).collect::<Vec<_>>());
    let mut few = vec![10_000, 3];
    sort(&mut few, 0, 10_001);
    assert_eq!(few, [3, 10_000]);
}
