//! Plans found again.

use crate::compile;
use crate::declaration::{Declaration, FrameSimilarity};
use crate::error::Error;
use crate::plan::Plan;
use std::sync::Arc;

/// How many plans are kept: enough for a few kinds of frames that alternate, and one more than there are plans whose
/// objects are kept, so that the memory of the oldest is free for the next frame.
const KEPT: usize = 5;

/// How plans were come by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PlanCounts {
    /// Compiled in full.
    pub compiled: u64,
    /// Compiled from the analysis of a plan that differed in sizes only.
    pub resized: u64,
    /// Taken from an equal frame.
    pub reused: u64,
}

/// The last few plans, the most recent first.
#[derive(Default)]
pub(crate) struct Plans {
    kept: Vec<Arc<Plan>>,
    pub(crate) counts: PlanCounts,
}

impl Plans {
    /// Returns the plan of a declaration, and leaves memory for another in its place.
    pub(crate) fn plan(&mut self, decl: &mut Declaration) -> Result<Arc<Plan>, Error> {
        let mut alike = None;
        for (index, plan) in self.kept.iter().enumerate() {
            match plan.decl.similarity(decl) {
                FrameSimilarity::Same => {
                    self.kept[..=index].rotate_right(1);
                    self.counts.reused += 1;
                    return Ok(self.kept[0].clone());
                }
                FrameSimilarity::OtherSizes => alike = alike.or(Some(plan)),
                FrameSimilarity::Other => {}
            }
        }
        let plan = match alike {
            Some(plan) => {
                self.counts.resized += 1;
                compile::resize(std::mem::take(decl), plan)?
            }
            None => {
                self.counts.compiled += 1;
                compile::compile(std::mem::take(decl))?
            }
        };
        let oldest = if self.kept.len() >= KEPT { self.kept.pop() } else { None };
        if let Some(oldest) = oldest.and_then(Arc::into_inner) {
            *decl = oldest.decl;
        }
        let plan = Arc::new(plan);
        self.kept.insert(0, plan.clone());
        Ok(plan)
    }
}
