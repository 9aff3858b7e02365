//! Lights that come, go and change over many frames.

use super::*;

/// What happens to a light between two frames.
#[derive(Clone, Copy, Debug)]
enum Change {
    ComesOrGoes,
    Size(f64),
    Grows(f64),
    Importance(f64),
    Tiles(u32),
}

fn any_change() -> impl Strategy<Value = Change> {
    prop_oneof![
        3 => Just(Change::ComesOrGoes),
        2 => any_size().prop_map(Change::Size),
        3 => (-0.5_f64..0.5).prop_map(Change::Grows),
        2 => any_importance().prop_map(Change::Importance),
        1 => any_tiles().prop_map(Change::Tiles),
    ]
}

/// For each frame which lights change and how.
fn any_frames() -> impl Strategy<Value = Vec<Vec<(usize, Change)>>> {
    let frame = proptest::collection::vec((any::<usize>(), any_change()), 0..6);
    proptest::collection::vec(frame, 50)
}

fn change(wish: &mut TileWish, present: &mut bool, change: Change, smallest_px: f64) {
    match change {
        Change::ComesOrGoes => *present = !*present,
        Change::Size(size) => wish.size_px = smallest_px * size.exp2(),
        Change::Grows(by) => wish.size_px *= by.exp2(),
        Change::Importance(importance) => wish.importance = importance,
        Change::Tiles(tiles) => wish.tiles = tiles,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn every_frame_keeps_every_rule(
        (rules, mut lights) in rules_and_wishes(24),
        frames in any_frames(),
    ) {
        let mut present = vec![true; lights.len()];
        let mut previous: Option<Allotment> = None;
        for changes in frames {
            for (light, what) in changes {
                let Some(i) = light.checked_rem(lights.len()) else { continue };
                change(&mut lights[i], &mut present[i], what, rules.smallest_px.into());
            }
            let here = lights.iter().zip(&present).filter(|(_, present)| **present);
            let wishes: Vec<TileWish> = here.map(|(wish, _)| *wish).collect();
            let got = allot(&rules, &wishes, previous.as_ref());
            naive::check(&rules, &wishes, previous.as_ref(), &got);
            previous = Some(got);
        }
    }

    #[test]
    fn a_first_frame_keeps_every_rule((rules, wishes) in rules_and_wishes(40)) {
        naive::check(&rules, &wishes, None, &allot(&rules, &wishes, None));
    }
}
