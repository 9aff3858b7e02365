use crate::{ConvexVolume, Plane};
use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::cull::samples::{boxes, recipe, volume};

fn test_each(boxes: &[Aabb], volume: &CullVolume) -> Vec<u32> {
    (0u32..).zip(boxes).filter(|(_, bounds)| volume.intersects(bounds)).map(|(item, _)| item).collect()
}

fn query(tree: &CullTree, volume: &CullVolume) -> Vec<u32> {
    let mut found = Vec::new();
    tree.query(volume, &mut found);
    found
}

fn around_all(boxes: &[Aabb]) -> Aabb {
    boxes.iter().map(within_space).fold(Aabb::EMPTY, |all, bounds| all.union(&bounds))
}

fn unit(x: f64) -> Aabb {
    Aabb { min: DVec3::X * x, max: DVec3::X * x + DVec3::ONE }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn a_query_finds_what_testing_each_box_finds(
        boxes in boxes(1..150), recipes in prop::collection::vec(recipe(), 8),
    ) {
        let tree = CullTree::new(&boxes);
        prop_assert_eq!(tree.bounds(), around_all(&boxes));
        for recipe in recipes {
            let volume = volume(&recipe, &boxes);
            prop_assert_eq!(query(&tree, &volume), test_each(&boxes, &volume));
        }
    }

    #[test]
    fn a_query_finds_what_testing_each_box_finds_after_a_refit(
        mut boxes in boxes(1..100), others in boxes(1..100), recipes in prop::collection::vec(recipe(), 4),
    ) {
        let mut tree = CullTree::new(&boxes);
        let changed: Vec<(u32, Aabb)> = (0u32..).step_by(3).zip(others).collect();
        tree.refit(changed.iter().copied());
        for (item, bounds) in changed {
            if let Some(slot) = boxes.get_mut(item as usize) {
                *slot = bounds;
            }
        }
        prop_assert_eq!(tree.bounds(), around_all(&boxes));
        prop_assert!((0u32..).zip(&boxes).all(|(item, bounds)| tree.item_bounds(item) == within_space(bounds)));
        for recipe in recipes {
            let volume = volume(&recipe, &boxes);
            prop_assert_eq!(query(&tree, &volume), test_each(&boxes, &volume));
        }
    }

    #[test]
    fn a_refit_fits_as_tightly_as_a_new_tree(boxes in boxes(1..100), others in boxes(1..100)) {
        let (mut tree, before) = (CullTree::new(&boxes), CullTree::new(&boxes));
        tree.refit((0u32..).zip(others));
        tree.refit((0u32..).zip(boxes));
        prop_assert_eq!(format!("{tree:?}"), format!("{before:?}"));
    }
}

#[test]
fn a_query_agrees_where_many_boxes_lie_far_from_the_origin() {
    let place = DVec3::new(1e7, -1e7, 1e7);
    let boxes: Vec<Aabb> = (0..20_000u32)
        .map(|i| {
            let at = place + DVec3::new(f64::from(i % 200), f64::from(i / 200), f64::from(i % 7)) / 3.0;
            Aabb { min: at, max: at + DVec3::splat(f64::from(i % 5)) / 7.0 }
        })
        .collect();
    let tree = CullTree::new(&boxes);
    for turn in 0..200 {
        let (sin, cos) = (f64::from(turn) * 0.7).sin_cos();
        let through = boxes[(turn * 97) as usize].max;
        let planes =
            vec![Plane::through(through, DVec3::new(sin, cos, 0.0)), Plane::through(through, DVec3::X)];
        let volume = CullVolume::from(ConvexVolume { planes });
        assert_eq!(query(&tree, &volume), test_each(&boxes, &volume));
    }
}

#[test]
fn a_tree_without_boxes_finds_nothing() {
    let mut tree = CullTree::new(&[]);
    tree.refit([(0, unit(0.0))]);
    assert!(query(&tree, &CullVolume::default()).is_empty());
    assert_eq!((tree.bounds(), tree.item_bounds(0)), (Aabb::EMPTY, Aabb::EMPTY));
}

#[test]
fn boxes_all_alike_are_all_found() {
    let tree = CullTree::new(&vec![unit(3.0); 1000]);
    assert_eq!(query(&tree, &CullVolume::default()), (0..1000).collect::<Vec<_>>());
}

#[test]
fn what_was_in_the_list_stays() {
    let tree = CullTree::new(&[unit(0.0), unit(5.0)]);
    let mut found = vec![9, 4];
    tree.query(&CullVolume::default(), &mut found);
    assert_eq!(found, [9, 4, 0, 1]);
}

#[test]
fn items_may_be_empty_and_come_back() {
    let mut tree = CullTree::new(&[unit(0.0), Aabb::EMPTY, unit(5.0)]);
    assert_eq!(query(&tree, &CullVolume::default()), [0, 2]);
    tree.refit([(1, unit(9.0)), (0, Aabb::EMPTY), (7, unit(99.0))]);
    assert_eq!(query(&tree, &CullVolume::default()), [1, 2]);
    assert_eq!(tree.bounds(), unit(5.0).union(&unit(9.0)));
    assert_eq!((tree.item_bounds(1), tree.item_bounds(7)), (unit(9.0), Aabb::EMPTY));
}

#[test]
fn threads_may_share_a_tree() {
    fn shared<T: Send + Sync>() {}
    shared::<CullTree>();
    shared::<CullVolume>();
}
