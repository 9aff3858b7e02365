//! Random frames against a simulation of their contents, pass by pass.

use crate::{Contents, Format, Frame, Plan, StoreAction, Texture, TextureDesc};
use proptest::prelude::*;

/// One pass: which textures it reads, which it writes and how (clear, cover, preserve).
type Step = (Vec<usize>, usize, u8);

const TEXTURES: usize = 5;

fn frame(steps: &[Step], exports: &[usize]) -> Option<Plan> {
    let mut frame = Frame::new();
    let mut textures: Vec<Texture> = (0..TEXTURES)
        .map(|i| {
            // Two shapes, so that some can share and some cannot.
            frame.create_texture(format!("t{i}"), TextureDesc::d2(8 + (i as u32 % 2), 8, Format::Rgba8Unorm))
        })
        .collect();
    let mut defined = [false; TEXTURES];
    for (index, (reads, write, how)) in steps.iter().enumerate() {
        let mut pass = frame.render_pass(format!("p{index}"));
        for &read in reads.iter().filter(|&&read| read != *write && defined[read]) {
            pass.sample(&textures[read]);
        }
        let contents = match how {
            0 => Contents::clear_color([0.0; 4]),
            1 => Contents::Cover,
            _ if defined[*write] => Contents::Preserve,
            _ => Contents::Cover,
        };
        pass.color(&mut textures[*write], contents);
        defined[*write] = true;
    }
    for &export in exports.iter().filter(|&&e| defined[e]) {
        frame.export_texture(&textures[export]);
    }
    Some(frame.compile().ok()?.into_plan())
}

/// Runs the plan on slots that hold "who wrote this": every read must find the version it named.
fn simulate(plan: &Plan) -> Result<(), String> {
    let mut slots: Vec<Option<(u32, u32)>> = vec![None; plan.slots.len()];
    for id in plan.live_passes() {
        let pass = plan.pass(id);
        for access in &pass.accesses {
            let resource = plan.resource(access.resource);
            let slot = &mut slots[resource.slot.ok_or("a live resource without a slot")?.index()];
            let reads = access.contents.is_none_or(|contents| contents.preserves());
            let expected = (access.resource.0, access.version);
            if reads && *slot != Some(expected) {
                return Err(format!("{} reads {expected:?} but finds {slot:?}", pass.name));
            }
        }
        for access in pass.accesses.iter().filter(|a| a.access.writes()) {
            let slot = plan.resource(access.resource).slot.ok_or("no slot")?;
            let stored = access.ops.ok_or("an attachment without ops")?.store == StoreAction::Store;
            slots[slot.index()] = stored.then_some((access.resource.0, access.version + 1));
        }
    }
    for (index, resource) in plan.resources.iter().enumerate().filter(|(_, r)| r.exported) {
        let accesses = plan.passes.iter().flat_map(|pass| &pass.accesses);
        let writes = accesses.filter(|a| a.resource.index() == index && a.access.writes()).count() as u32;
        let slot = resource.slot.ok_or("an export without a slot")?;
        if slots[slot.index()] != Some((index as u32, writes)) {
            return Err(format!(
                "the slot of the exported {} holds {:?}",
                resource.name,
                slots[slot.index()]
            ));
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2_000) })]

    #[test]
    fn every_read_finds_the_version_it_named(
        steps in prop::collection::vec((prop::collection::vec(0..TEXTURES, 0..3), 0..TEXTURES, 0u8..4), 1..14),
        exports in prop::collection::vec(0..TEXTURES, 1..3),
    ) {
        let plan = frame(&steps, &exports).expect("random frames are valid");
        prop_assert!(simulate(&plan).is_ok(), "{:?}\n{}", simulate(&plan), plan.to_text());
        let before_after = |d: &crate::Dependency| d.before < d.after;
        prop_assert!(plan.dependencies.iter().all(before_after));
        prop_assert_eq!(&plan, &frame(&steps, &exports).expect("again"));
    }
}

#[test]
fn the_simulation_catches_a_store_that_was_lost() {
    let steps = [(vec![], 0, 0), (vec![0], 1, 1)];
    let mut plan = frame(&steps, &[1]).expect("valid");
    assert!(simulate(&plan).is_ok());
    plan.passes[0].accesses[0].ops.as_mut().expect("ops").store = StoreAction::Discard;
    assert!(simulate(&plan).is_err());
}

#[test]
fn the_simulation_catches_a_slot_shared_too_early() {
    let steps = [(vec![], 0, 0), (vec![], 2, 0), (vec![0, 2], 1, 1)];
    let mut plan = frame(&steps, &[1]).expect("valid");
    assert!(simulate(&plan).is_ok());
    plan.resources[2].slot = plan.resources[0].slot;
    assert!(simulate(&plan).is_err());
}
