//! From declarations to a plan, by small pure functions.

mod alias;
mod cull;
mod lifetime;
mod merge;
mod ops;
mod order;
mod plan;
mod validate;

#[cfg(test)]
mod tests;

use crate::declaration::Declaration;
use crate::error::Error;
use crate::plan::Plan;

/// Compiles a frame's declarations.
///
/// Merging comes before lifetimes and slots: passes that share a render pass cannot share an attachment's slot.
pub(crate) fn compile(declaration: Declaration) -> Result<Plan, Error> {
    let decl = &declaration;
    validate::validate(decl)?;
    let culled = cull::cull(decl);
    let order = order::order(&culled);
    let steps = merge::merge(&order);
    let lifetimes = lifetime::lifetimes(decl, &steps);
    let usages = lifetime::usages(decl, &order);
    let aliasing = alias::alias(decl, &lifetimes, &usages);
    let ops = ops::ops(decl, &order);
    let dependencies = order::dependencies(decl, &order);
    Ok(plan::assemble(
        declaration,
        plan::Parts { culled, steps, lifetimes, usages, aliasing, ops, dependencies },
    ))
}
