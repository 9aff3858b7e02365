//! Aliasing: which resources share a physical texture or buffer, by interval colouring over the final order.

use super::csr::Csr;
use super::lifetime::Use;
use crate::declaration::{Declaration, Origin, ResourceDecl};
use crate::desc::{BufferDesc, ResourceDesc};
use crate::handle::{ResourceId, SlotId};
use crate::plan::{Placement, Slot, SlotReason};
use rustc_hash::FxHashMap;
use wgpu_types::{BufferUsages, TextureDimension, TextureUsages};

/// Slots, their resources, and the placement of each resource.
pub(super) struct Aliasing {
    pub(super) placements: Vec<Placement>,
    pub(super) slots: Vec<Slot>,
    pub(super) resources: Vec<ResourceId>,
}

/// Resources of the same class can share a slot: same description, same kind of memory.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Class {
    desc: ResourceDesc,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Kind {
    /// Used only within one render pass.
    Transient,
    Common,
    /// Storage usage can disable the compression of attachments, so storage textures do not share with others.
    Storage,
}

/// Assigns each transient resource a slot of its class that is free for its whole lifetime.
///
/// Resources are assigned in order of first use, to any free slot. This needs as many slots of a class as its resources
/// live at once, which is the minimum.
pub(super) fn alias(decl: &Declaration, uses: &[Use], steps: usize) -> Aliasing {
    let mut colouring = Colouring::new(decl, uses);
    let begins = by_step(uses, steps, |(first, _)| first);
    let ends = by_step(uses, steps, |(_, last)| last);
    for step in 0..steps {
        for &resource in begins.row(step) {
            colouring.begin(resource);
        }
        for &resource in ends.row(step) {
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
    /// State of each slot.
    states: Vec<State>,
    keys: FxHashMap<Class, u32>,
    /// Slots of each class, by its key.
    classes: Vec<FreeSlots>,
    /// Slots with the resources assigned to them, in order of first use.
    assigned: Vec<(usize, ResourceId)>,
}

const NONE: u32 = u32::MAX;

struct State {
    class: u32,
    /// The resource in the slot, or the last one that was.
    resource: ResourceId,
    /// The next slot in the list of free ones.
    next_free: u32,
}

/// The free slots of a class, as a list through `State`, and the last one that was assigned.
struct FreeSlots {
    free: u32,
    last_assigned: u32,
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
            self.classes.push(FreeSlots { free: NONE, last_assigned: NONE });
        }
        let (slot, reason) = self.assign(key, resource, class.desc);
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

    /// Assigns the slot of a class that became free last, or a new one.
    fn assign(&mut self, class: u32, resource: ResourceId, desc: ResourceDesc) -> (usize, SlotReason) {
        let slots = &mut self.classes[class as usize];
        let busy = std::mem::replace(&mut slots.last_assigned, slots.free);
        if slots.free != NONE {
            let slot = slots.free as usize;
            slots.free = self.states[slot].next_free;
            return (slot, SlotReason::After(self.states[slot].resource));
        }
        let slot = self.slots.len();
        slots.last_assigned = slot as u32;
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
            // An export is returned to the caller, so it has the requested size.
            let bytes = if declared.exported.is_some() { desc.bytes } else { size_class(desc.bytes) };
            Class {
                desc: ResourceDesc::Buffer(BufferDesc { bytes, element_bytes: None }),
                kind: Kind::Common,
            }
        }
        ResourceDesc::Texture(desc) => {
            let flat = desc.dimension == TextureDimension::D2
                && desc.mip_levels == 1
                && desc.size.depth_or_array_layers == 1;
            let within_one_pass = own.only_drawn && own.steps.is_some_and(|(first, last)| first == last);
            let kind = if own.texture_usage.contains(TextureUsages::STORAGE_BINDING) {
                Kind::Storage
            } else if decl.options.transient_attachments
                && flat
                && within_one_pass
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

/// Sorts resources by a step of their lifetime.
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
