//! The plan contains exactly what was declared.

use super::super::frames::{Names, SubresourceSpec};
use super::{Oracle, Rule};
use crate::{Plan, Subresource};

impl Oracle<'_> {
    pub(super) fn declared(&mut self, names: &Names, plan: &Plan) {
        let spec = self.model.spec;
        let counts = (plan.pass_count(), plan.resources().len());
        self.expect(counts == (spec.passes.len(), spec.resources.len()), Rule::Declared, || {
            format!("{counts:?}")
        });
        if !self.breaches.is_empty() {
            return;
        }
        for (index, resource) in spec.resources.iter().enumerate() {
            let planned = plan.resource(names.id(index));
            let same = (planned.desc, planned.origin, planned.exported)
                == (resource.desc, resource.origin, spec.is_exported(index));
            self.expect(same, Rule::Declared, || format!("resource {index} is {planned:?}"));
        }
        let mut versions = vec![0; spec.resources.len()];
        for ((id, planned), pass) in plan.passes().zip(&spec.passes) {
            let same = (planned.kind, planned.keep) == (pass.kind, pass.keep);
            self.expect(same, Rule::Declared, || format!("{id:?} is {planned:?}"));
            let count = plan.accesses(id).len();
            self.expect(count == pass.accesses.len(), Rule::Declared, || {
                format!("{id:?} has {count} accesses")
            });
            for (planned, access) in plan.accesses(id).zip(&pass.accesses) {
                let expected = (names.id(access.resource), access.access, access.contents);
                let version = versions[access.resource];
                let same = (planned.resource, planned.access, planned.contents) == expected;
                let subresource = planned.subresource == access.subresource.to_subresource()
                    || self.is_whole(access.resource, access.subresource, planned.subresource);
                self.expect(same && subresource && planned.version == version, Rule::Declared, || {
                    format!("{id:?} has {planned:?} for {access:?}")
                });
                versions[access.resource] += u32::from(access.writes());
            }
        }
    }

    fn is_whole(&self, resource: usize, subresource: SubresourceSpec, planned: Subresource) -> bool {
        planned == Subresource::FULL
            && subresource.cells(&self.model.cells[resource]) == self.model.whole(resource)
    }
}
