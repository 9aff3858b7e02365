//! Variants of a plan that keep contents, for captures and checks of values.

use super::{alias, lifetime, ops};
use crate::desc::ResourceDesc;
use crate::handle::ResourceId;
use crate::plan::{AttachmentOps, MergeReason, Plan, StoreAction, StructureId};
use wgpu_types::{BufferUsages, TextureUsages};

/// Plans the same passes in the same order, but without merging, with every attachment stored, and each resource in its
/// own memory that can be copied from. Passes read the same contents as in the original plan. Textures have the usages `textures` too.
pub(crate) fn keeping(plan: &Plan, textures: TextureUsages) -> Plan {
    let decl = &plan.decl;
    let steps: Vec<(u32, u32)> =
        (0..plan.order.len() as u32).map(|position| (position, position + 1)).collect();
    let mut uses = lifetime::uses(decl, &plan.order, &steps);
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
    let mut ops = ops::ops(decl, &plan.order, &steps);
    for ops in ops.iter_mut().flatten() {
        ops.store = StoreAction::Store;
    }
    variant(plan, steps, &uses, ops, vec![MergeReason::Off; plan.order.len()])
}

/// Plans the same passes in the same order, so that a texture can be copied after the pass at a position, which writes it: that pass is the
/// last of its step, and what it draws is stored.
pub(crate) fn watching(plan: &Plan, position: usize, texture: ResourceId) -> Plan {
    let decl = &plan.decl;
    let after = position as u32 + 1;
    let split = |&(start, end): &(u32, u32)| match start < after && after < end {
        true => vec![(start, after), (after, end)],
        false => vec![(start, end)],
    };
    let steps: Vec<(u32, u32)> = plan.steps.iter().flat_map(split).collect();
    let mut uses = lifetime::uses(decl, &plan.order, &steps);
    let own = &mut uses[texture.0 as usize];
    own.only_drawn = false;
    own.texture_usage |= TextureUsages::COPY_SRC;
    let mut ops = ops::ops(decl, &plan.order, &steps);
    let written = decl.access_range(plan.order[position]);
    for (access, ops) in decl.accesses[written.clone()].iter().zip(&mut ops[written]) {
        if access.resource == texture
            && let Some(ops) = ops
        {
            ops.store = StoreAction::Store;
        }
    }
    variant(plan, steps, &uses, ops, plan.merge_reasons.clone())
}

/// Returns a plan with other steps.
fn variant(
    plan: &Plan,
    steps: Vec<(u32, u32)>,
    uses: &[lifetime::Use],
    ops: Vec<Option<AttachmentOps>>,
    merge_reasons: Vec<MergeReason>,
) -> Plan {
    let decl = plan.decl.clone();
    let alias::Aliasing { placements, slots, resources: slot_resources } =
        alias::alias(&decl, uses, steps.len());
    Plan {
        structure: StructureId::new(),
        merge_reasons,
        steps,
        ops,
        placements,
        slots,
        slot_resources,
        decl,
        ..plan.clone()
    }
}
