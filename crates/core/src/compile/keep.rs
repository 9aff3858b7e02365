//! A variant of a plan that keeps all contents, for captures and checks of values.

use super::{alias, lifetime, ops};
use crate::desc::ResourceDesc;
use crate::plan::{MergeReason, Plan, StoreAction, StructureId};
use wgpu_types::{BufferUsages, TextureUsages};

/// Plans the same passes in the same order, but without merging, with every attachment stored, and each resource in its
/// own memory that can be copied from. Passes read the same contents as in the original plan. Textures have the usages `textures` too.
pub(crate) fn keeping(plan: &Plan, textures: TextureUsages) -> Plan {
    let decl = plan.decl.clone();
    let steps: Vec<(u32, u32)> =
        (0..plan.order.len() as u32).map(|position| (position, position + 1)).collect();
    let mut uses = lifetime::uses(&decl, &plan.order, &steps);
    let last = steps.len().saturating_sub(1) as u32;
    for (own, resource) in uses.iter_mut().zip(&decl.resources) {
        // No resource reuses its slot.
        own.steps = own.steps.map(|(first, _)| (first, last));
        own.only_drawn = false;
        match resource.desc {
            ResourceDesc::Texture(_) => own.texture_usage |= textures,
            ResourceDesc::Buffer(_) => own.buffer_usage |= BufferUsages::COPY_SRC,
        }
    }
    let mut ops = ops::ops(&decl, &plan.order, &steps);
    for ops in ops.iter_mut().flatten() {
        ops.store = StoreAction::Store;
    }
    let alias::Aliasing { placements, slots, resources: slot_resources } =
        alias::alias(&decl, &uses, steps.len());
    Plan {
        structure: StructureId::new(),
        merge_reasons: vec![MergeReason::Off; plan.order.len()],
        steps,
        ops,
        placements,
        slots,
        slot_resources,
        decl,
        ..plan.clone()
    }
}
