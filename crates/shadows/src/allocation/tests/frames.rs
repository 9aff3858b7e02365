//! Lights that are added, removed and changed over many frames.

use super::*;

/// A change of a light between two frames.
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

/// The lights that change in each frame, and how.
fn any_frames() -> impl Strategy<Value = Vec<Vec<(usize, Change)>>> {
    let frame = proptest::collection::vec((any::<usize>(), any_change()), 0..6);
    proptest::collection::vec(frame, 50)
}

fn change(request: &mut TileRequest, present: &mut bool, change: Change, smallest_px: f64) {
    match change {
        Change::ComesOrGoes => *present = !*present,
        Change::Size(size) => request.size_px = smallest_px * size.exp2(),
        Change::Grows(by) => request.size_px *= by.exp2(),
        Change::Importance(importance) => request.importance = importance,
        Change::Tiles(tiles) => request.tiles = tiles,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn every_frame_obeys_every_rule(
        (config, mut lights) in config_and_requests(24),
        frames in any_frames(),
    ) {
        let mut present = vec![true; lights.len()];
        let mut previous: Option<AtlasAllocation> = None;
        for changes in frames {
            for (light, what) in changes {
                let Some(i) = light.checked_rem(lights.len()) else { continue };
                change(&mut lights[i], &mut present[i], what, config.smallest_px.into());
            }
            let here = lights.iter().zip(&present).filter(|(_, present)| **present);
            let requests: Vec<TileRequest> = here.map(|(request, _)| *request).collect();
            let got = allocate_tiles(&config, &requests, previous.as_ref());
            reference::check(&config, &requests, previous.as_ref(), &got);
            previous = Some(got);
        }
    }

    #[test]
    fn a_first_frame_obeys_every_rule((config, requests) in config_and_requests(40)) {
        reference::check(&config, &requests, None, &allocate_tiles(&config, &requests, None));
    }
}
