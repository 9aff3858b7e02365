//! Every order of a frame's passes.

use crate::Origin;
use crate::compile::tests::frames::Spec;
use crate::compile::tests::oracle::Model;

/// The orders of some passes that keep every hazard.
pub(super) struct Orders {
    /// Passes as declared.
    pub(super) passes: Vec<usize>,
    /// Predecessors by index in `passes`, as bits.
    before: Vec<usize>,
    /// Bytes of each transient resource, its users as bits, and whether it is exported.
    resources: Vec<(u64, usize, bool)>,
}

impl Orders {
    pub(super) fn new(spec: &Spec, live: &[usize]) -> Self {
        let mut passes = live.to_vec();
        passes.sort_unstable();
        let model = Model::new(spec);
        let bits = |holds: &dyn Fn(usize) -> bool| {
            (0..passes.len())
                .filter(|&position| holds(position))
                .fold(0, |bits, position| bits | 1 << position)
        };
        let before = (0..passes.len())
            .map(|at| bits(&|position| position < at && model.ordered(passes[position], passes[at])))
            .collect();
        let transient = |r: &usize| spec.resources[*r].origin == Origin::Transient;
        let resources = (0..spec.resources.len()).filter(transient).map(|resource| {
            let touches = |position: usize| {
                spec.passes[passes[position]].accesses.iter().any(|a| a.resource == resource)
            };
            (spec.desc(resource).bytes(), bits(&touches), spec.is_exported(resource))
        });
        let resources = resources.collect();
        Self { passes, before, resources }
    }

    /// The least and the greatest peak. What is in use depends on which passes have run and not on their order, so it
    /// is enough to go through all sets of passes.
    pub(super) fn peaks(&self) -> (u64, u64) {
        let count = self.passes.len();
        let mut peaks: Vec<Option<(u64, u64)>> = vec![None; 1 << count];
        peaks[0] = Some((0, 0));
        for done in 0..1usize << count {
            let Some((least, most)) = peaks[done] else { continue };
            for next in 0..count {
                let ready = done >> next & 1 == 0 && self.before[next] & !done == 0;
                if ready {
                    let used = self.used(done, next);
                    let (least, most) = (least.max(used), most.max(used));
                    let then = &mut peaks[done | 1 << next];
                    *then = Some(then.map_or((least, most), |known| (known.0.min(least), known.1.max(most))));
                }
            }
        }
        peaks[(1 << count) - 1].unwrap_or_default()
    }

    /// Bytes in use while `next` runs after those of `done`.
    fn used(&self, done: usize, next: usize) -> u64 {
        let begun = done | 1 << next;
        let lives = |(_, users, exported): &&(u64, usize, bool)| {
            users & begun != 0 && (*exported || users & !done != 0)
        };
        self.resources.iter().filter(lives).map(|(bytes, ..)| bytes).sum()
    }
}
