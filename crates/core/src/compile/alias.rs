//! Which resources take turns in one physical texture or buffer: interval colouring over the final order.

use super::csr::Csr;
use super::lifetime::Use;
use crate::declaration::{Declaration, Origin, ResourceDecl};
use crate::desc::{BufferDesc, ResourceDesc};
use crate::handle::{ResourceId, SlotId};
use crate::plan::{Placement, Slot, SlotReason};
use rustc_hash::FxHashMap;
use wgpu_types::{BufferUsages, TextureDimension, TextureUsages};

/// Where each resource lives, and the slots with their resources.
pub(super) struct Aliasing {
    pub(super) placements: Vec<Placement>,
    pub(super) slots: Vec<Slot>,
    pub(super) resources: Vec<ResourceId>,
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
    placements: Vec<Placement>,
    slots: Vec<Slot>,
    /// By slot.
    states: Vec<State>,
    keys: FxHashMap<Class, u32>,
    /// By key of a class.
    classes: Vec<Stock>,
    /// Slots with the resources assigned to them, in order of first use.
    assigned: Vec<(usize, ResourceId)>,
}

const NONE: u32 = u32::MAX;

struct State {
    class: u32,
    /// The resource in the slot, or the last one that was.
    resource: ResourceId,
    /// The slot that is free after this one is taken.
    next_free: u32,
}

/// The slots of a class.
struct Stock {
    free: u32,
    taken_last: u32,
}

impl<'d> Colouring<'d> {
    fn new(decl: &'d Declaration, uses: &'d [Use]) -> Self {
        let placement = |(own, resource): (&Use, &ResourceDecl)| Placement {
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
        let placements: Vec<Placement> = uses.iter().zip(&decl.resources).map(placement).collect();
        let (slots, states, classes) = (Vec::new(), Vec::new(), Vec::new());
        let (keys, assigned) = (FxHashMap::default(), Vec::with_capacity(placements.len()));
        Self { decl, uses, placements, slots, states, keys, classes, assigned }
    }

    fn begin(&mut self, resource: ResourceId) {
        if self.decl.resource(resource).origin != Origin::Transient {
            return;
        }
        let class = class(self.decl, self.uses, resource);
        let next = self.classes.len() as u32;
        let key = *self.keys.entry(class).or_insert(next);
        if key == next {
            self.classes.push(Stock { free: NONE, taken_last: NONE });
        }
        let (slot, reason) = self.take(key, resource, class.desc);
        self.states[slot].resource = resource;
        self.assigned.push((slot, resource));
        let placement = &mut self.placements[resource.index()];
        if class.kind == Kind::Transient {
            placement.texture_usage |= TextureUsages::TRANSIENT_ATTACHMENT;
        }
        (placement.slot, placement.reason) = (Some(SlotId(slot as u32)), reason);
        self.slots[slot].texture_usage |= placement.texture_usage;
        self.slots[slot].buffer_usage |= placement.buffer_usage;
    }

    /// Takes the slot of a class that became free last, or a new one.
    fn take(&mut self, class: u32, resource: ResourceId, desc: ResourceDesc) -> (usize, SlotReason) {
        let stock = &mut self.classes[class as usize];
        let busy = std::mem::replace(&mut stock.taken_last, stock.free);
        if stock.free != NONE {
            let slot = stock.free as usize;
            stock.free = self.states[slot].next_free;
            return (slot, SlotReason::After(self.states[slot].resource));
        }
        let slot = self.slots.len();
        stock.taken_last = slot as u32;
        let (texture_usage, buffer_usage) = (TextureUsages::empty(), BufferUsages::empty());
        self.slots.push(Slot { desc, texture_usage, buffer_usage, resources: (0, 0) });
        self.states.push(State { class, resource, next_free: NONE });
        let reason = match busy {
            NONE => SlotReason::FirstOfClass,
            busy => SlotReason::AllBusy(self.states[busy as usize].resource),
        };
        (slot, reason)
    }

    fn end(&mut self, resource: ResourceId) {
        if let Some(SlotId(slot)) = self.placements[resource.index()].slot {
            let state = &mut self.states[slot as usize];
            state.next_free = std::mem::replace(&mut self.classes[state.class as usize].free, slot);
        }
    }

    fn finish(mut self) -> Aliasing {
        let assigned = Csr::new(self.slots.len(), || self.assigned.iter().copied());
        for (index, slot) in self.slots.iter_mut().enumerate() {
            slot.resources = assigned.range(index);
        }
        Aliasing { placements: self.placements, slots: self.slots, resources: assigned.into_items() }
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
fn by_step(uses: &[Use], steps: usize, step: impl Fn((u32, u32)) -> u32) -> Csr<ResourceId> {
    Csr::new(steps, || {
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
