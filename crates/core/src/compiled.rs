//! A compiled frame, and the resolution of tokens.

use crate::frame::Frame;
use crate::plan::Plan;
#[cfg(any(feature = "gpu", test))]
use crate::{
    error::Error,
    handle::{PassId, ResourceId, Token},
};
use std::sync::Arc;

/// A compiled frame: the plan, and the pass bodies to record.
pub struct Compiled<'f> {
    pub(crate) plan: Arc<Plan>,
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

/// Returns the resource of a token used in `pass`: only tokens of that pass resolve.
#[cfg(any(feature = "gpu", test))]
pub(crate) fn resolve(plan: &Plan, frame: u64, pass: PassId, token: Token) -> Result<ResourceId, Error> {
    if token.frame != frame {
        return Err(Error::ForeignHandle { location: format!("pass `{}`", plan.pass_path(pass)) });
    }
    if token.pass != pass {
        return Err(Error::Undeclared {
            pass: plan.pass_path(pass),
            resource: plan.resource(token.resource).name.into(),
            declared_by: plan.pass_path(token.pass),
        });
    }
    Ok(token.resource)
}
