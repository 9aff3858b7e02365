//! Putting the parts together.

use super::alias::Aliasing;
use super::lifetime::Lifetime;
use crate::declaration::Declaration;
use crate::plan::{
    AccessPlan, AttachmentOps, CullReason, Dependency, NodePlan, PassPlan, Plan, ResourcePlan, Step,
};
use wgpu_types::{BufferUsages, TextureUsages};

/// What the earlier functions found.
pub(super) struct Parts {
    pub(super) culled: Vec<Option<CullReason>>,
    pub(super) steps: Vec<Step>,
    pub(super) lifetimes: Vec<Lifetime>,
    pub(super) usages: Vec<(TextureUsages, BufferUsages)>,
    pub(super) aliasing: Aliasing,
    pub(super) ops: Vec<Vec<Option<AttachmentOps>>>,
    pub(super) dependencies: Vec<Dependency>,
}

/// Takes the declaration apart: its names move into the plan.
pub(super) fn assemble(decl: Declaration, parts: Parts) -> Plan {
    let nodes = decl.nodes.into_iter().map(|n| NodePlan { name: n.name, parent: n.parent }).collect();
    let passes = decl.passes.into_iter().zip(&parts.culled).zip(&parts.ops);
    let passes = passes
        .map(|((pass, &culled), ops)| PassPlan {
            name: pass.name,
            node: pass.node,
            kind: pass.kind,
            accesses: pass
                .accesses
                .iter()
                .zip(ops)
                .map(|(access, &ops)| AccessPlan {
                    resource: access.resource,
                    access: access.access,
                    contents: access.contents,
                    version: access.version,
                    ops,
                })
                .collect(),
            copies: pass.copies,
            culled,
        })
        .collect();
    let resources = decl
        .resources
        .into_iter()
        .enumerate()
        .map(|(index, resource)| ResourcePlan {
            name: resource.name,
            desc: resource.desc,
            origin: resource.origin,
            exported: resource.exported.is_some(),
            texture_usage: parts.usages[index].0,
            buffer_usage: parts.usages[index].1,
            steps: parts.lifetimes[index],
            slot: parts.aliasing.slot_of[index],
        })
        .collect();
    Plan {
        nodes,
        passes,
        resources,
        slots: parts.aliasing.slots,
        order: parts.steps,
        dependencies: parts.dependencies,
    }
}
