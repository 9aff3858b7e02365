use proptest::prelude::*;

use super::*;
use crate::bounds::{ConvexVolume, Plane};
use crate::cull::samples::{boxes, shapes, volume};

fn test_each(boxes: &[Aabb], volume: &CullVolume) -> Vec<u32> {
    (0u32..).zip(boxes).filter(|(_, bounds)| volume.intersects(bounds)).map(|(item, _)| item).collect()
}

fn query(tree: &CullTree, volume: &CullVolume) -> Vec<u32> {
    let mut found = Vec::new();
    tree.query(volume, &mut found);
    found
}

fn around_all(boxes: &[Aabb]) -> Aabb {
    boxes.iter().map(clip_to_space).fold(Aabb::EMPTY, |all, bounds| all.union(&bounds))
}

fn unit(x: f64) -> Aabb {
    Aabb { min: DVec3::X * x, max: DVec3::X * x + DVec3::ONE }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400.max(ProptestConfig::default().cases)))]

    #[test]
    fn a_query_finds_what_testing_each_box_finds(
        boxes in boxes(1..150), all_shapes in prop::collection::vec(shapes(), 8),
    ) {
        let tree = CullTree::new(&boxes);
        prop_assert_eq!(tree.bounds(), around_all(&boxes));
        for shapes in all_shapes {
            let volume = volume(&shapes, &boxes);
            prop_assert_eq!(query(&tree, &volume), test_each(&boxes, &volume));
        }
    }

    #[test]
    fn a_query_finds_what_testing_each_box_finds_after_a_refit(
        mut boxes in boxes(1..100), others in boxes(1..100), all_shapes in prop::collection::vec(shapes(), 4),
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
        prop_assert!((0u32..).zip(&boxes).all(|(item, bounds)| tree.item_bounds(item) == clip_to_space(bounds)));
        for shapes in all_shapes {
            let volume = volume(&shapes, &boxes);
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
    let center = DVec3::new(1e7, -1e7, 1e7);
    let boxes: Vec<Aabb> = (0..20_000u32)
        .map(|i| {
            let min = center + DVec3::new(f64::from(i % 200), f64::from(i / 200), f64::from(i % 7)) / 3.0;
            Aabb { min, max: min + DVec3::splat(f64::from(i % 5)) / 7.0 }
        })
        .collect();
    let tree = CullTree::new(&boxes);
    for i in 0..200 {
        let (sin, cos) = (f64::from(i) * 0.7).sin_cos();
        let through = boxes[(i * 97) as usize].max;
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
fn identical_boxes_are_all_found() {
    let tree = CullTree::new(&vec![unit(3.0); 1000]);
    assert_eq!(query(&tree, &CullVolume::default()), (0..1000).collect::<Vec<_>>());
}

#[test]
fn a_query_keeps_the_earlier_contents_of_the_list() {
    let tree = CullTree::new(&[unit(0.0), unit(5.0)]);
    let mut found = vec![9, 4];
    tree.query(&CullVolume::default(), &mut found);
    assert_eq!(found, [9, 4, 0, 1]);
}

#[test]
fn items_may_become_empty_and_return() {
    let mut tree = CullTree::new(&[unit(0.0), Aabb::EMPTY, unit(5.0)]);
    assert_eq!(query(&tree, &CullVolume::default()), [0, 2]);
    tree.refit([(1, unit(9.0)), (0, Aabb::EMPTY), (7, unit(99.0))]);
    assert_eq!(query(&tree, &CullVolume::default()), [1, 2]);
    assert_eq!(tree.bounds(), unit(5.0).union(&unit(9.0)));
    assert_eq!((tree.item_bounds(1), tree.item_bounds(7)), (unit(9.0), Aabb::EMPTY));
}

#[test]
fn trees_and_volumes_are_send_and_sync() {
    fn shared<T: Send + Sync>() {}
    shared::<CullTree>();
    shared::<CullVolume>();
}

#[test]
fn a_tree_is_degraded_when_many_nodes_have_grown_and_good_again_when_it_is_rebuilt() {
    let boxes: Vec<Aabb> = (0..1000).map(|i| unit(f64::from(i) * 2.0)).collect();
    let mut tree = CullTree::new(&boxes);
    // One item that is far away, and all that move a little, are no reason to build the tree again.
    tree.refit([(3, unit(1e6))]);
    assert!(!tree.is_degraded());
    tree.refit((0..1000).map(|i| (i, unit(f64::from(i) * 2.0 + 0.5))));
    assert!(!tree.is_degraded());
    // Neighbours that are now far apart.
    let shuffled = |i: u32| unit(f64::from(i * 617 % 1000) * 2.0);
    for first in (0..1000).step_by(50) {
        tree.refit((first..first + 50).map(|i| (i, shuffled(i))));
    }
    assert!(tree.is_degraded());
    tree.rebuild();
    assert!(!tree.is_degraded());
    let planes = vec![Plane::through(DVec3::X * 1900.5, DVec3::X)];
    let boxes: Vec<Aabb> = (0..1000).map(shuffled).collect();
    let volume = CullVolume::from(ConvexVolume { planes });
    assert_eq!(query(&tree, &volume), test_each(&boxes, &volume));
}
