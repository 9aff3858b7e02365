#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;

fn walk(node: Node, items: usize, depth: usize, visit: &mut impl FnMut(Node, usize)) {
    visit(node, depth);
    for half in node.halves().into_iter().flatten() {
        assert!(!half.slots(items).is_empty());
        walk(half, items, depth + 1, visit);
    }
}

#[test]
fn every_slot_is_in_one_leaf_and_every_node_has_its_number() {
    assert_eq!(Node::root(0), None);
    for items in (1..200).chain([1000, 4097]) {
        let root = Node::root(items).unwrap();
        let (mut numbers, mut slots) = (Vec::new(), Vec::new());
        walk(root, items, 0, &mut |node, _| {
            numbers.push(node.number);
            if node.halves().is_none() {
                slots.extend(node.slots(items));
            }
        });
        assert_eq!(numbers, (0..root.count()).collect::<Vec<_>>());
        assert_eq!(slots, (0..items).collect::<Vec<_>>());
    }
}

#[test]
fn halves_share_the_slots_of_their_node() {
    walk(Node::root(1003).unwrap(), 1003, 0, &mut |node, _| {
        let own = node.slots(1003);
        assert!((0..1003).all(|slot| node.has(slot) == own.contains(&slot)));
        if let Some([first, second]) = node.halves() {
            assert_eq!((first.slots(1003).start, second.slots(1003).end), (own.start, own.end));
            assert_eq!(first.slots(1003).end, second.slots(1003).start);
            assert_eq!(first.slots(1003).len(), first.capacity());
        }
    });
}

#[test]
fn a_million_items_are_no_deeper_than_their_number_needs() {
    let mut deepest = 0;
    walk(Node::root(1_000_000).unwrap(), 1_000_000, 0, &mut |_, depth| deepest = deepest.max(depth));
    assert_eq!(deepest, 17);
}
