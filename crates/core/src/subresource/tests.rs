//! Boxes and sets of them against bitmaps of a small universe.
#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::desc::{BufferDesc, Format};
use proptest::prelude::*;

/// Aspects, mips, layers, texels across and down. A box that reaches the end extends to infinity.
const SIDES: [u64; AXES] = [2, 3, 2, 4, 4];
const CELLS: usize = 2 * 3 * 2 * 4 * 4;

type Bitmap = [bool; CELLS];

fn bitmap(holds: impl Fn([u64; AXES]) -> bool) -> Bitmap {
    std::array::from_fn(|cell| {
        let mut rest = cell as u64;
        holds(SIDES.map(|side| {
            let at = rest % side;
            rest /= side;
            at
        }))
    })
}

fn cells(region: &Region) -> Bitmap {
    bitmap(|at| (0..AXES).all(|axis| region.start[axis] <= at[axis] && at[axis] < region.end[axis]))
}

fn cells_of(set: &RegionSet) -> Bitmap {
    let boxes: Vec<Bitmap> = set.boxes.iter().map(cells).collect();
    for (index, one) in boxes.iter().enumerate() {
        let apart = |other: &Bitmap| (0..CELLS).all(|cell| !(one[cell] && other[cell]));
        assert!(boxes[..index].iter().all(apart), "boxes overlap: {set:?}");
        assert!(one.contains(&true), "a box is empty: {set:?}");
    }
    std::array::from_fn(|cell| boxes.iter().any(|one| one[cell]))
}

fn both(a: &Bitmap, b: &Bitmap, join: impl Fn(bool, bool) -> bool) -> Bitmap {
    std::array::from_fn(|cell| join(a[cell], b[cell]))
}

fn region() -> impl Strategy<Value = Region> {
    let range = |axis: usize| {
        let side = SIDES[axis];
        (0..side).prop_flat_map(move |start| (Just(start), start + 1..=side, any::<bool>()))
    };
    let ranges = (range(0), range(1), range(2), range(3), range(4), any::<[bool; AXES]>());
    ranges.prop_map(|(a, b, c, d, e, whole)| {
        let mut region = Region::ALL;
        for (axis, (start, end, _)) in [a, b, c, d, e].into_iter().enumerate() {
            if !whole[axis] {
                region.start[axis] = start;
                region.end[axis] = if end == SIDES[axis] { END } else { end };
            }
        }
        region
    })
}

#[derive(Clone, Debug)]
enum SetChange {
    Add(Region),
    Subtract(Region),
    Clip(Region),
}

fn change() -> impl Strategy<Value = SetChange> {
    prop_oneof![
        4 => region().prop_map(SetChange::Add),
        2 => region().prop_map(SetChange::Subtract),
        1 => region().prop_map(SetChange::Clip),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2_000) })]

    #[test]
    fn boxes_overlap_and_contain_as_their_cells_do(a in region(), b in region()) {
        let (one, other) = (cells(&a), cells(&b));
        let shared = both(&one, &other, |a, b| a && b);
        prop_assert_eq!(a.overlaps(&b), shared.contains(&true));
        prop_assert_eq!(a.contains(&b), shared == other);
        prop_assert_eq!(a == b, one == other, "one way to say a box");
    }

    #[test]
    fn sets_hold_what_their_cells_say(changes in prop::collection::vec(change(), 0..9), query in region()) {
        let (mut set, mut expected) = (RegionSet::default(), [false; CELLS]);
        for change in &changes {
            match change {
                SetChange::Add(region) => {
                    set.add(*region);
                    expected = both(&expected, &cells(region), |a, b| a || b);
                }
                SetChange::Subtract(region) => {
                    set.subtract(region);
                    expected = both(&expected, &cells(region), |a, b| a && !b);
                }
                SetChange::Clip(region) => {
                    set.clip(region);
                    expected = both(&expected, &cells(region), |a, b| a && b);
                }
            }
            prop_assert_eq!(cells_of(&set), expected);
        }
        let wanted = cells(&query);
        let common = both(&expected, &wanted, |a, b| a && b);
        prop_assert_eq!(set.overlaps(&query), common.contains(&true));
        prop_assert_eq!(set.contains(&query), common == wanted);
        prop_assert_eq!(set.is_empty(), !expected.contains(&true));
    }
}

#[test]
fn an_attachment_is_all_texels_of_its_mips_layers_and_aspects() {
    let desc = ResourceDesc::Texture(TextureDesc::d2(64, 64, Format::Depth24PlusStencil8).layers(4));
    let subresource = Subresource::FULL.layer(2).aspect(Aspect::Depth);
    let tile = subresource.rect(Rect::new(0, 0, 32, 64)).region(&desc).unwrap();
    assert_eq!(tile.without_rect(), subresource.region(&desc).unwrap());
    assert_eq!(tile.subresources(), Subresource::FULL.layer(2).region(&desc).unwrap());
}

#[test]
fn the_whole_of_a_resource_is_no_part_however_it_is_said() {
    let texture = ResourceDesc::Texture(TextureDesc::d2(64, 32, Format::Depth32Float).layers(4));
    let whole = Subresource::FULL.mips(0..1).layers(0..4).aspect(Aspect::Depth).rect(Rect::new(0, 0, 64, 32));
    assert_eq!(whole.region(&texture), None);
    assert_eq!(Subresource::FULL.bytes(0..64).region(&ResourceDesc::Buffer(BufferDesc::new(64))), None);
}

#[test]
fn parts_that_a_resource_does_not_have_are_reported() {
    let texture =
        ResourceDesc::Texture(TextureDesc { mip_levels: 2, ..TextureDesc::d2(64, 64, Format::R8Unorm) });
    let buffer = ResourceDesc::Buffer(BufferDesc::new(64));
    let (rect, most) = (Rect::new(40, 0, 32, 32), u32::MAX);
    for (subresource, desc) in [
        (Subresource::FULL.mip(2), &texture),
        (Subresource::FULL.mip(most), &texture),
        (Subresource::FULL.mips(1..1), &texture),
        (Subresource::FULL.layer(1), &texture),
        (Subresource::FULL.aspect(Aspect::Depth), &texture),
        (Subresource::FULL.rect(Rect::new(0, 0, 8, 8)), &texture),
        (Subresource::FULL.mip(0).rect(rect), &texture),
        (Subresource::FULL.mip(1).rect(Rect::new(0, 0, 64, 64)), &texture),
        (Subresource::FULL.mip(0).rect(Rect::new(most, most, most, most)), &texture),
        (Subresource::FULL.mip(0).rect(Rect::new(0, 0, 0, 8)), &texture),
        (Subresource::FULL.bytes(0..4), &texture),
        (Subresource::FULL.bytes(32..96), &buffer),
        (Subresource::FULL.bytes(8..8), &buffer),
        (Subresource::FULL.mip(0), &buffer),
    ] {
        assert!(subresource.problem(desc).is_some(), "{subresource:?}");
    }
    assert_eq!(Subresource::FULL.mip(1).rect(Rect::new(0, 0, 32, 32)).problem(&texture), None);
}

#[test]
fn subresources_are_described() {
    assert_eq!(Subresource::FULL.to_string(), "all");
    assert_eq!(Subresource::FULL.mip(1).layers(2..4).to_string(), "mip 1, layers 2..4");
    assert_eq!(
        Subresource::FULL.aspect(Aspect::Stencil).rect(Rect::new(3, 4, 1, 2)).to_string(),
        "stencil, 1x2 at 3,4"
    );
    assert_eq!(Subresource::FULL.bytes(0..16).to_string(), "bytes 0..16");
}
