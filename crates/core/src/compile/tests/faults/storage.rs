//! Faults in slots and usages of resources.

use super::{Stage, Work, search};
use crate::compile::tests::oracle::Rule;
use crate::declaration::Origin;
use crate::desc::{BufferDesc, ResourceDesc};
use crate::handle::ResourceId;
use crate::plan::StoreAction;
use wgpu_types::{BufferUsages, TextureUsages};

fn transient(work: &Work) -> impl Iterator<Item = usize> + use<> {
    let origins: Vec<bool> = work.plan.decl.resources.iter().map(|r| r.origin == Origin::Transient).collect();
    (0..origins.len()).rev().filter(move |&resource| origins[resource])
}

/// Lifetimes in the plan are kept right, so that only the fault itself can be found.
fn correct_lifetimes(work: &mut Work) {
    let uses = crate::compile::lifetime::uses(&work.plan.decl, &work.plan.order, &work.plan.steps);
    for (placement, own) in work.plan.placements.iter_mut().zip(&uses) {
        placement.steps = own.steps;
    }
}

#[test]
fn a_slot_freed_one_step_early() {
    let shorten = |stage, work: &mut Work| match stage {
        Stage::Lifetime => {
            let mut shortened = false;
            for resource in transient(work) {
                if let Some((first, last)) = &mut work.uses[resource].steps
                    && first < last
                {
                    *last -= 1;
                    shortened = true;
                }
            }
            Some(shortened)
        }
        Stage::Alias => {
            correct_lifetimes(work);
            None
        }
        _ => None,
    };
    search(&[Rule::Slots], shorten).caught(100);
}

#[test]
fn an_export_that_lives_to_its_last_access_only() {
    let shorten = |stage, work: &mut Work| match stage {
        Stage::Lifetime => {
            let mut shortened = false;
            let mut decl = work.plan.decl.clone();
            decl.resources.iter_mut().for_each(|resource| resource.exported = None);
            let uses = crate::compile::lifetime::uses(&decl, &work.plan.order, &work.plan.steps);
            for resource in transient(work) {
                shortened |= work.uses[resource].steps != uses[resource].steps;
                work.uses[resource].steps = uses[resource].steps;
            }
            Some(shortened)
        }
        Stage::Alias => {
            correct_lifetimes(work);
            None
        }
        _ => None,
    };
    search(&[Rule::Slots], shorten).caught(20);
}

#[test]
fn two_live_resources_in_one_slot() {
    let share = |stage, work: &mut Work| {
        for a in (stage == Stage::Alias).then(|| transient(work))? {
            for b in transient(work).filter(|&b| b < a) {
                let (one, other) = (work.plan.placements[a], work.plan.placements[b]);
                let both = |placement: &crate::plan::Placement| Some((placement.slot?, placement.steps?));
                let (Some((slot, (first, last))), Some((taken, (start, end)))) = (both(&one), both(&other))
                else {
                    continue;
                };
                let slots = &work.plan.slots;
                let alike = slots[slot.index()].desc == slots[taken.index()].desc && slot != taken;
                let usages = slots[slot.index()].texture_usage == slots[taken.index()].texture_usage;
                if alike && usages && first <= end && start <= last {
                    work.move_to(a, taken);
                    return Some(true);
                }
            }
        }
        Some(false)
    };
    search(&[Rule::Slots], share).always_caught();
}

#[test]
fn a_slot_that_is_too_small() {
    let shrink = |stage, work: &mut Work| {
        let slots = (stage == Stage::Alias).then_some(&mut work.plan.slots)?;
        let large = slots.iter_mut().find(|s| matches!(s.desc, ResourceDesc::Buffer(d) if d.bytes > 4));
        let shrunk = large.map(|slot| slot.desc = ResourceDesc::Buffer(BufferDesc::new(4)));
        Some(shrunk.is_some())
    };
    search(&[Rule::Slots], shrink).always_caught();
}

#[test]
fn a_usage_that_was_lost() {
    let lose = |stage, work: &mut Work| {
        for resource in (stage == Stage::Lifetime).then(|| transient(work))? {
            let own = &mut work.uses[resource];
            let lost = own.texture_usage.iter().last().filter(|_| own.steps.is_some());
            if let Some(lost) = lost {
                own.texture_usage -= lost;
                return Some(true);
            }
            let lost = own.buffer_usage.iter().last().filter(|_| own.steps.is_some());
            if let Some(lost) = lost {
                own.buffer_usage -= lost;
                return Some(true);
            }
        }
        Some(false)
    };
    search(&[Rule::Usages], lose).always_caught();
}

#[test]
fn a_usage_that_a_slot_lacks() {
    let lose = |stage, work: &mut Work| {
        let slots = (stage == Stage::Alias).then_some(&mut work.plan.slots)?;
        let used = slots.iter_mut().find(|slot| slot.texture_usage.bits().count_ones() > 1);
        let lost = used.map(|slot| slot.texture_usage = TextureUsages::COPY_DST);
        Some(lost.is_some())
    };
    search(&[Rule::Usages], lose).always_caught();
}

#[test]
fn a_usage_of_a_culled_pass() {
    let add = |stage, work: &mut Work| {
        let used =
            (stage == Stage::Lifetime).then(|| transient(work).find(|&r| work.uses[r].steps.is_some()))?;
        let buffer =
            |r: usize| matches!(work.plan.decl.resource(ResourceId(r as u32)).desc, ResourceDesc::Buffer(_));
        let used = used.filter(|&r| buffer(r) && !work.uses[r].buffer_usage.contains(BufferUsages::INDIRECT));
        used.map(|r| work.uses[r].buffer_usage |= BufferUsages::INDIRECT).is_some().into()
    };
    search(&[Rule::Usages], add).always_caught();
}

#[test]
fn a_transient_attachment_that_is_stored() {
    let mark = |stage, work: &mut Work| {
        for index in (stage == Stage::Alias).then_some(0..work.plan.ops.len())? {
            let resource = work.plan.decl.accesses[index].resource;
            let stored = work.plan.ops[index].is_some_and(|ops| ops.store == StoreAction::Store);
            if let (true, Some(slot)) = (stored, work.plan.placements[resource.index()].slot) {
                let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TRANSIENT_ATTACHMENT;
                work.plan.placements[resource.index()].texture_usage = usage;
                work.plan.slots[slot.index()].texture_usage = usage;
                return Some(true);
            }
        }
        Some(false)
    };
    search(&[Rule::TransientAttachment], mark).always_caught();
}

#[test]
fn a_transient_attachment_that_was_not_used() {
    let refuse = |stage, work: &mut Work| {
        let uses = (stage == Stage::Lifetime).then_some(&mut work.uses)?;
        uses.iter_mut().for_each(|own| own.only_drawn = false);
        Some(work.plan.decl.options.transient_attachments)
    };
    search(&[Rule::TransientAttachment], refuse).always_caught();
}
