//! Which resources take turns in one physical texture or buffer: interval colouring over the final order.

use super::lifetime::Use;
use super::lists::Lists;
use crate::declaration::{Declaration, Origin};
use crate::desc::{BufferDesc, ResourceDesc};
use crate::handle::{ResourceId, SlotId};
use crate::plan::{Fate, Slot, SlotReason};
use rustc_hash::FxHashMap;
use wgpu_types::{BufferUsages, TextureDimension, TextureUsages};

/// Where each resource lives, and the slots with their tenants.
pub(super) struct Aliasing {
    pub(super) fates: Vec<Fate>,
    pub(super) slots: Vec<Slot>,
    pub(super) tenants: Vec<ResourceId>,
}

/// What may share a slot: the same shape, and the same kind of memory.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Class {
    desc: ResourceDesc,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    /// Never leaves a render pass.
    Transient,
    Common,
    /// Storage usage can switch off the compression of attachments, so storage textures keep to themselves.
    Storage,
}

/// Gives each transient resource a slot of its class that is free for its whole lifetime.
///
/// Taking resources by first use, and any slot that is free, needs as many slots of a class as resources of it live
/// at once, which is the least there can be.
pub(super) fn alias(decl: &Declaration, uses: &[Use], steps: usize) -> Aliasing {
    let mut colouring = Colouring::new(decl, uses);
    let begins = by_step(uses, steps, |(first, _)| first);
    let ends = by_step(uses, steps, |(_, last)| last);
    for step in 0..steps {
        for &resource in begins.of(step) {
            colouring.begin(resource);
        }
        for &resource in ends.of(step) {
            colouring.end(resource);
        }
    }
    colouring.finish()
}

struct Colouring<'d> {
    decl: &'d Declaration,
    uses: &'d [Use],
    fates: Vec<Fate>,
    slots: Vec<Slot>,
    /// By slot: its class, and who was in it last.
    states: Vec<(u32, ResourceId)>,
    /// By slot.
    counts: Vec<u32>,
    classes: FxHashMap<Class, u32>,
    /// By class: free slots, and the slot taken last.
    free: Vec<(Vec<u32>, u32)>,
}

impl<'d> Colouring<'d> {
    fn new(decl: &'d Declaration, uses: &'d [Use]) -> Self {
        let fate = |(own, resource): (&Use, &crate::declaration::ResourceDecl)| Fate {
            texture_usage: own.texture_usage,
            buffer_usage: own.buffer_usage,
            steps: own.steps,
            slot: None,
            reason: match resource.origin {
                Origin::Imported { .. } => SlotReason::Imported,
                Origin::Previous { .. } | Origin::Current { .. } => SlotReason::History,
                Origin::Transient => SlotReason::Unused,
            },
        };
        let fates = uses.iter().zip(&decl.resources).map(fate).collect();
        let (slots, states, counts) = (Vec::new(), Vec::new(), Vec::new());
        let (classes, free) = (FxHashMap::default(), Vec::new());
        Self { decl, uses, fates, slots, states, counts, classes, free }
    }

    fn begin(&mut self, resource: ResourceId) {
        if self.decl.resource(resource).origin != Origin::Transient {
            return;
        }
        let class = class(self.decl, self.uses, resource);
        let next = self.free.len() as u32;
        let key = *self.classes.entry(class).or_insert(next);
        if key == next {
            self.free.push((Vec::new(), u32::MAX));
        }
        let (free, taken) = &mut self.free[key as usize];
        let reason = match (free.last(), *taken) {
            (Some(&slot), _) => SlotReason::After(self.states[slot as usize].1),
            (None, u32::MAX) => SlotReason::FirstOfClass,
            (None, busy) => SlotReason::AllBusy(self.states[busy as usize].1),
        };
        let slot = free.pop().unwrap_or_else(|| {
            let (texture_usage, buffer_usage) = (TextureUsages::empty(), BufferUsages::empty());
            self.slots.push(Slot { desc: class.desc, texture_usage, buffer_usage, tenants: (0, 0) });
            self.states.push((key, resource));
            self.counts.push(0);
            self.slots.len() as u32 - 1
        });
        *taken = slot;
        self.states[slot as usize].1 = resource;
        self.counts[slot as usize] += 1;
        let fate = &mut self.fates[resource.index()];
        if class.kind == Kind::Transient {
            fate.texture_usage |= TextureUsages::TRANSIENT_ATTACHMENT;
        }
        (fate.slot, fate.reason) = (Some(SlotId(slot)), reason);
        self.slots[slot as usize].texture_usage |= fate.texture_usage;
        self.slots[slot as usize].buffer_usage |= fate.buffer_usage;
    }

    fn end(&mut self, resource: ResourceId) {
        if let Some(slot) = self.fates[resource.index()].slot {
            let (class, _) = self.states[slot.index()];
            self.free[class as usize].0.push(slot.0);
        }
    }

    /// Lists the tenants of each slot, in order of their first use.
    fn finish(mut self) -> Aliasing {
        let mut start = 0;
        for (slot, count) in self.slots.iter_mut().zip(&self.counts) {
            slot.tenants = (start, start);
            start += count;
        }
        let mut tenants = vec![ResourceId(0); start as usize];
        let mut housed: Vec<ResourceId> = Vec::with_capacity(tenants.len());
        housed.extend(
            (0..self.fates.len() as u32).map(ResourceId).filter(|r| self.fates[r.index()].slot.is_some()),
        );
        housed.sort_by_key(|resource| self.fates[resource.index()].steps);
        for resource in housed {
            if let Some(slot) = self.fates[resource.index()].slot {
                let end = &mut self.slots[slot.index()].tenants.1;
                tenants[*end as usize] = resource;
                *end += 1;
            }
        }
        Aliasing { fates: self.fates, slots: self.slots, tenants }
    }
}

fn class(decl: &Declaration, uses: &[Use], resource: ResourceId) -> Class {
    let (own, declared) = (&uses[resource.index()], decl.resource(resource));
    match declared.desc {
        ResourceDesc::Buffer(desc) => {
            // What is exported is handed out, so it has the size that was asked for.
            let bytes = if declared.exported.is_some() { desc.bytes } else { size_class(desc.bytes) };
            Class { desc: ResourceDesc::Buffer(BufferDesc { bytes }), kind: Kind::Common }
        }
        ResourceDesc::Texture(desc) => {
            let flat = desc.dimension == TextureDimension::D2
                && desc.mip_levels == 1
                && desc.size.depth_or_array_layers == 1;
            let within_a_pass = own.only_drawn && own.steps.is_some_and(|(first, last)| first == last);
            let kind = if own.texture_usage.contains(TextureUsages::STORAGE_BINDING) {
                Kind::Storage
            } else if decl.options.transient_attachments
                && flat
                && within_a_pass
                && own.texture_usage == TextureUsages::RENDER_ATTACHMENT
            {
                Kind::Transient
            } else {
                Kind::Common
            };
            Class { desc: declared.desc, kind }
        }
    }
}

/// Rounds up to 4, 5, 6 or 7 times a power of two, at least 256: at most a quarter is wasted.
fn size_class(bytes: u64) -> u64 {
    let bytes = bytes.max(256);
    let quarter = (bytes.next_power_of_two() / 8).max(1);
    bytes.next_multiple_of(quarter)
}

/// Resources by the step that something happens to them at.
fn by_step(uses: &[Use], steps: usize, step: impl Fn((u32, u32)) -> u32) -> Lists<ResourceId> {
    Lists::new(steps, || {
        let resources = (0..).map(ResourceId).zip(uses);
        resources.filter_map(|(resource, own)| Some((step(own.steps?) as usize, resource)))
    })
}

#[cfg(test)]
mod tests {
    use super::size_class;

    #[test]
    fn size_classes_waste_at_most_a_quarter() {
        for bytes in [4, 256, 257, 300, 1_000, 65_536, 65_537, 1 << 30, (1 << 30) + 4] {
            let class = size_class(bytes);
            assert!(class >= bytes && class.is_multiple_of(4), "{bytes} in {class}");
            assert!(class == 256 || class - bytes <= bytes / 4, "{bytes} in {class}");
            assert_eq!(size_class(class), class, "{bytes}");
        }
    }
}
