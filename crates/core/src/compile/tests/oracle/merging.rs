//! Passes that share a render pass.

use super::super::frames::AccessSpec;
use super::{Live, Oracle, Rule};
use crate::{Access, Contents, PassKind, Plan};

impl Oracle<'_> {
    pub(super) fn merging(&mut self, plan: &Plan, live: &Live) {
        let last = live.steps.last().map_or(0, |last| last + 1);
        for step in 0..last {
            let group: Vec<usize> = (0..live.order.len())
                .filter(|&position| live.steps[position] == step)
                .map(|at| live.order[at])
                .collect();
            if group.len() > 1 {
                self.expect(plan.options().merge, Rule::Merging, || "merging is switched off".into());
                self.group(&group);
            }
        }
    }

    fn group(&mut self, group: &[usize]) {
        let kinds = group.iter().all(|&pass| self.model.spec.passes[pass].kind == PassKind::Render);
        self.expect(kinds, Rule::Merging, || format!("{group:?} are not all render passes"));
        for &pass in &group[1..] {
            let same = self.same_attachments(group[0], pass);
            self.expect(same, Rule::Merging, || format!("p{pass} has other attachments than p{}", group[0]));
            let clears = self.model.accesses(pass).any(|(_, access, cells)| {
                matches!(access.contents, Some(Contents::Clear(_))) && cells == self.model.attachment(access)
            });
            self.expect(!clears, Rule::Merging, || {
                format!("p{pass} clears all of an attachment within a render pass")
            });
        }
        for &pass in &group[..group.len() - 1] {
            let resolves =
                self.model.spec.passes[pass].accesses.iter().any(|a| matches!(a.access, Access::Resolve(_)));
            self.expect(!resolves, Rule::Merging, || format!("p{pass} resolves within a render pass"));
        }
        for (at, &later) in group.iter().enumerate() {
            for &earlier in &group[..at] {
                let hazard = self.hazard(earlier, later);
                self.expect(!hazard, Rule::Merging, || format!("p{earlier} and p{later} exclude each other"));
            }
        }
    }

    /// Same textures, same mips and layers, for the same purpose, in the same order.
    pub(super) fn same_attachments(&self, a: usize, b: usize) -> bool {
        let attachments = |pass: usize| {
            let attached = self.model.spec.passes[pass].accesses.iter().filter(|access| access.attached());
            attached.map(|access| (access.resource, access.access, self.model.attachment(access)))
        };
        attachments(a).eq(attachments(b))
    }

    /// Returns whether wgpu's tracking within one render pass would refuse the two together, or the second could not
    /// see what the first did: one writes what the other touches, and not both draw into it.
    fn hazard(&self, a: usize, b: usize) -> bool {
        let clash = |first: &AccessSpec, second: &AccessSpec| {
            let both_attached = first.attached() && second.attached();
            first.resource == second.resource
                && (first.writes() || second.writes())
                && !both_attached
                && self.model.subresources(first).overlaps(&self.model.subresources(second))
        };
        let (first, second) = (&self.model.spec.passes[a].accesses, &self.model.spec.passes[b].accesses);
        first.iter().any(|first| second.iter().any(|second| clash(first, second)))
    }
}
