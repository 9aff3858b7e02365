//! Which resources take turns in one physical texture or buffer: interval colouring over the final order.

use super::lifetime::Lifetime;
use crate::declaration::{Declaration, Origin};
use crate::desc::ResourceDesc;
use crate::handle::{ResourceId, SlotId};
use crate::plan::SlotPlan;
use wgpu_types::{BufferUsages, TextureUsages};

/// The slots, and the slot of each resource.
pub(super) struct Aliasing {
    pub(super) slots: Vec<SlotPlan>,
    pub(super) slot_of: Vec<Option<SlotId>>,
}

/// Gives each transient resource a slot of its own shape that is free for its whole lifetime.
///
/// Taking resources by first use, and the first slot that is free, uses as few slots of each shape as any order
/// could. Usages of tenants are united, except that a storage texture never shares with one that is not: storage
/// usage can switch off the compression of attachments.
pub(super) fn alias(
    decl: &Declaration,
    lifetimes: &[Lifetime],
    usages: &[(TextureUsages, BufferUsages)],
) -> Aliasing {
    let mut by_first_use: Vec<(u32, u32, usize)> = lifetimes
        .iter()
        .enumerate()
        .filter(|&(index, _)| decl.resources[index].origin == Origin::Transient)
        .filter_map(|(index, lifetime)| lifetime.map(|(first, last)| (first, last, index)))
        .collect();
    by_first_use.sort_by_key(|&(first, _, index)| (first, index));

    let mut slots: Vec<SlotPlan> = Vec::new();
    let mut busy_until: Vec<u32> = Vec::new();
    let mut slot_of = vec![None; decl.resources.len()];
    for (first, last, index) in by_first_use {
        let desc = decl.resources[index].desc;
        let (texture_usage, buffer_usage) = usages[index];
        let fits = |slot: &SlotPlan| slot.desc == desc && is_storage(slot) == stores(desc, texture_usage);
        let free = (0..slots.len()).find(|&slot| busy_until[slot] < first && fits(&slots[slot]));
        let slot = free.unwrap_or_else(|| {
            slots.push(SlotPlan { desc, texture_usage, buffer_usage, tenants: Vec::new() });
            busy_until.push(0);
            slots.len() - 1
        });
        slots[slot].texture_usage |= texture_usage;
        slots[slot].buffer_usage |= buffer_usage;
        slots[slot].tenants.push(ResourceId(index as u32));
        busy_until[slot] = last;
        slot_of[index] = Some(SlotId(slot as u32));
    }
    Aliasing { slots, slot_of }
}

fn is_storage(slot: &SlotPlan) -> bool {
    stores(slot.desc, slot.texture_usage)
}

fn stores(desc: ResourceDesc, usage: TextureUsages) -> bool {
    matches!(desc, ResourceDesc::Texture(_)) && usage.contains(TextureUsages::STORAGE_BINDING)
}
