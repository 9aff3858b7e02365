//! Positions of passes and lifetimes of resources, read off the plan's order.

use super::{Model, spec_pass};
use crate::{Origin, Plan};

/// The passes that run.
pub(in super::super) struct Live {
    /// Passes in order, as indices in the spec.
    pub(in super::super) order: Vec<usize>,
    /// Position of each pass in the order.
    pub(in super::super) positions: Vec<Option<usize>>,
    /// Step of each position in the order.
    pub(in super::super) steps: Vec<usize>,
    /// First and last step in which each resource must keep its contents.
    pub(in super::super) spans: Vec<Option<(usize, usize)>>,
}

impl Live {
    pub(super) fn new(model: &Model<'_>, plan: &Plan) -> Self {
        let order: Vec<usize> = plan.order().iter().map(|&id| spec_pass(id)).collect();
        let mut positions = vec![None; model.spec.passes.len()];
        order.iter().enumerate().for_each(|(position, &pass)| positions[pass] = Some(position));
        let steps: Vec<usize> =
            plan.steps().enumerate().flat_map(|(step, run)| vec![step; run.passes.len()]).collect();
        let last = steps.last().copied().unwrap_or(0);
        let span = |resource: usize| {
            let touches =
                |&&pass: &&usize| model.accesses(pass).any(|(_, access, _)| access.resource == resource);
            let at = |pass: &usize| positions[*pass].map(|position| steps[position]);
            let first = order.iter().find(touches).and_then(at)?;
            let end = order.iter().rev().find(touches).and_then(at)?;
            Some((first, if model.spec.is_exported(resource) { last } else { end }))
        };
        let spans = (0..model.spec.resources.len()).map(span).collect();
        Self { order, positions, steps, spans }
    }

    /// Returns the resources in slots, with their spans.
    pub(super) fn assigned(&self, model: &Model<'_>) -> Vec<(usize, (usize, usize))> {
        let transient = |resource: &usize| model.spec.resources[*resource].origin == Origin::Transient;
        let resources = (0..self.spans.len()).filter(transient);
        resources.filter_map(|resource| Some((resource, self.spans[resource]?))).collect()
    }
}
