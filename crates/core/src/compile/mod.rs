//! Compiles declarations to a plan, by small pure functions.

mod alias;
mod coverage;
mod csr;
mod cull;
mod hazards;
#[cfg(feature = "gpu")]
mod keep;
mod lifetime;
mod merge;
mod ops;
mod order;
mod validate;

#[cfg(test)]
mod tests;

#[cfg(feature = "gpu")]
pub(crate) use keep::{keeping, watching};
#[cfg(feature = "gpu")]
pub(crate) use validate::copy_extent;

use crate::declaration::Declaration;
use crate::error::Error;
use crate::plan::{CullReason, Dependency, Plan, StructureId};
use tracing::debug_span;

/// Compiles a frame's declarations.
pub(crate) fn compile(decl: Declaration) -> Result<Plan, Error> {
    let _span = debug_span!("compile", passes = decl.passes.len()).entered();
    debug_span!("validate").in_scope(|| validate::validate(&decl))?;
    let culled = debug_span!("cull").in_scope(|| cull::cull(&decl));
    let dependencies = debug_span!("hazards").in_scope(|| hazards::hazards(&decl, &culled));
    Ok(schedule(decl, culled, dependencies))
}

/// Compiles declarations that differ from those of a plan only in sizes: the same passes run, for the same reasons.
pub(crate) fn resize(decl: Declaration, plan: &Plan) -> Result<Plan, Error> {
    let _span = debug_span!("resize", passes = decl.passes.len()).entered();
    debug_span!("validate").in_scope(|| validate::validate(&decl))?;
    Ok(schedule(decl, plan.culled.clone(), plan.dependencies.clone()))
}

/// Compiles declarations that differ from those of a plan only in clear values: everything but load operations is the same.
pub(crate) fn reclear(decl: Declaration, plan: &Plan) -> Result<Plan, Error> {
    let _span = debug_span!("reclear", passes = decl.passes.len()).entered();
    validate::validate_clears(&decl)?;
    let ops = ops::ops(&decl, &plan.order, &plan.steps);
    let Plan {
        decl: _,
        structure,
        culled,
        order,
        order_reasons,
        merge_reasons,
        steps,
        ops: _,
        placements,
        slots,
        slot_resources,
        dependencies,
    } = plan;
    Ok(Plan {
        decl,
        structure: *structure,
        culled: culled.clone(),
        order: order.clone(),
        order_reasons: order_reasons.clone(),
        merge_reasons: merge_reasons.clone(),
        steps: steps.clone(),
        ops,
        placements: placements.clone(),
        slots: slots.clone(),
        slot_resources: slot_resources.clone(),
        dependencies: dependencies.clone(),
    })
}

/// Makes the decisions that depend on sizes.
///
/// Merging comes before lifetimes and slots: passes that share a render pass cannot share an attachment's slot.
fn schedule(decl: Declaration, culled: Vec<Option<CullReason>>, dependencies: Vec<Dependency>) -> Plan {
    let (order, order_reasons) =
        debug_span!("order").in_scope(|| order::order(&decl, &culled, &dependencies));
    let (steps, merge_reasons) = debug_span!("merge").in_scope(|| merge::merge(&decl, &order));
    let uses = debug_span!("lifetime").in_scope(|| lifetime::uses(&decl, &order, &steps));
    let ops = debug_span!("ops").in_scope(|| ops::ops(&decl, &order, &steps));
    let aliasing = debug_span!("alias").in_scope(|| alias::alias(&decl, &uses, steps.len()));
    let alias::Aliasing { placements, slots, resources: slot_resources } = aliasing;
    Plan {
        decl,
        structure: StructureId::new(),
        culled,
        order,
        order_reasons,
        merge_reasons,
        steps,
        ops,
        placements,
        slots,
        slot_resources,
        dependencies,
    }
}
