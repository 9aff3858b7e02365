//! A compiled frame.

use crate::compile;
use crate::error::Error;
use crate::frame::Frame;
use crate::plan::Plan;
use std::sync::Arc;

/// A compiled frame: the plan, and the pass bodies to record.
pub struct Compiled<'f> {
    pub(crate) plan: Arc<Plan>,
    /// Its declaration is in the plan, except for the places of passes: equal frames share the plan.
    #[cfg_attr(not(feature = "gpu"), allow(dead_code, reason = "bodies and uploads are for the executor"))]
    pub(crate) frame: Frame<'f>,
}

impl<'f> Compiled<'f> {
    pub(crate) fn new(plan: Arc<Plan>, frame: Frame<'f>) -> Self {
        Self { plan, frame }
    }

    /// Returns the plan.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the plan, which equal frames share.
    pub fn shared_plan(&self) -> Arc<Plan> {
        self.plan.clone()
    }

    /// Returns the plan and drops the bodies.
    pub fn into_plan(self) -> Plan {
        let plan = self.plan.clone();
        drop(self);
        Arc::unwrap_or_clone(plan)
    }
}

impl<'f> Frame<'f> {
    /// Compiles the declarations into a plan. [`Graph::compile`](crate::Graph::compile) does the same and reuses the
    /// plan of an equal frame.
    ///
    /// # Errors
    /// The first error of the declaration, in order of declaration.
    pub fn compile(mut self) -> Result<Compiled<'f>, Error> {
        self.check()?;
        let plan = compile::compile(std::mem::take(&mut self.decl))?;
        self.decl.places.clone_from(&plan.decl.places);
        Ok(Compiled::new(Arc::new(plan), self))
    }
}
