//! Reuse of plans.

use crate::compile;
use crate::declaration::{Declaration, FrameSimilarity};
use crate::error::Error;
use crate::plan::Plan;
use std::sync::Arc;

/// Number of plans kept: enough for a few kinds of frames that alternate, and one more than the plans whose objects are
/// kept, so that the memory of the oldest is free for the next frame.
const MAX_PLANS: usize = 5;

/// Counts how plans were obtained.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlanCounts {
    /// Plans compiled in full.
    pub compiled: u64,
    /// Plans compiled from the analysis of a plan that differed only in sizes.
    pub resized: u64,
    /// Plans taken from one that differed only in clear values.
    pub cleared: u64,
    /// Plans reused from an equal frame.
    pub reused: u64,
}

/// The last few plans, the most recent first.
#[derive(Default)]
pub(crate) struct Plans {
    kept: Vec<Arc<Plan>>,
    pub(crate) counts: PlanCounts,
}

impl Plans {
    /// Returns the plan of a declaration, and replaces the declaration, except for the places of passes, by memory for
    /// another.
    pub(crate) fn plan(&mut self, decl: &mut Declaration) -> Result<Arc<Plan>, Error> {
        let mut similar = None;
        let mut other_clears = None;
        for (index, plan) in self.kept.iter().enumerate() {
            // Plans with other clear values are the same but for these, so one is enough.
            if other_clears.is_some() && plan.decl.clears != decl.clears {
                continue;
            }
            match plan.decl.similarity(decl) {
                FrameSimilarity::Same => {
                    self.kept[..=index].rotate_right(1);
                    self.counts.reused += 1;
                    return Ok(self.kept[0].clone());
                }
                FrameSimilarity::OtherClears => other_clears = Some(plan),
                FrameSimilarity::OtherSizes => similar = similar.or(Some(plan)),
                FrameSimilarity::Other => {}
            }
        }
        let plan = match (other_clears, similar) {
            (Some(plan), _) => {
                self.counts.cleared += 1;
                compile::reclear(std::mem::take(decl), plan)?
            }
            (None, Some(plan)) => {
                self.counts.resized += 1;
                compile::resize(std::mem::take(decl), plan)?
            }
            (None, None) => {
                self.counts.compiled += 1;
                compile::compile(std::mem::take(decl))?
            }
        };
        let oldest = if self.kept.len() >= MAX_PLANS { self.kept.pop() } else { None };
        if let Some(oldest) = oldest.and_then(Arc::into_inner) {
            *decl = oldest.decl;
        }
        decl.places.clone_from(&plan.decl.places);
        let plan = Arc::new(plan);
        self.kept.insert(0, plan.clone());
        Ok(plan)
    }
}
