//! Why passes stand where they do.

use super::bytes;
use crate::plan::{Dependency, DependencyKind, OrderReason, Plan};

impl Plan {
    /// Says why a pass stands where it does in the order. A pass is ready when all it depends on has run.
    pub fn describe_order(&self, reason: OrderReason) -> String {
        match reason {
            OrderReason::Fixed => "the frame fixes the order of declaration".into(),
            OrderReason::OnlyReady => "it was the only pass ready".into(),
            OrderReason::ContinuesRenderPass => "of those ready, it goes on with the open render pass".into(),
            OrderReason::FreesMemory(0) => "of those ready, it alone takes no more memory".into(),
            OrderReason::FreesMemory(freed) => {
                let verb = if freed > 0 { "frees the most" } else { "takes the least" };
                format!("of those ready, it {verb} memory, {}", bytes(freed.unsigned_abs()))
            }
            OrderReason::DeclaredFirst => "of those ready and best for memory, it was declared first".into(),
            OrderReason::BackwardsNeedsLess => {
                "chosen from the last pass to the first, passes need the least memory".into()
            }
            OrderReason::DeclarationNeedsLess => {
                "as declared: choosing for memory would have needed more".into()
            }
        }
    }

    /// Says why one pass must follow another.
    pub(in crate::dump) fn explain_dependency(&self, dependency: &Dependency) -> String {
        let (before, after) = (self.pass_path(dependency.before), self.pass_path(dependency.after));
        let name = dependency.resource.map_or("", |resource| self.resource(resource).name);
        match dependency.kind {
            DependencyKind::ReadAfterWrite => format!("`{after}` needs what `{before}` wrote to `{name}`"),
            DependencyKind::WriteAfterRead => {
                format!("`{after}` writes over `{name}`, which `{before}` reads")
            }
            DependencyKind::WriteAfterWrite => {
                format!("`{after}` writes over what `{before}` wrote to `{name}`")
            }
            DependencyKind::Explicit => format!("`{after}` was declared to run after `{before}`"),
        }
    }
}
