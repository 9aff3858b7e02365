//! The order of passes, by list scheduling.

mod heap;
mod memory;
mod traffic;

use super::csr::Csr;
use super::merge::{self, Group};
use crate::declaration::{Declaration, OrderPolicy, PassKind};
use crate::handle::PassId;
use crate::plan::{CullReason, Dependency, MergeReason, OrderReason};
use heap::Ready;
use memory::Memory;
use traffic::Traffic;

/// Maximum number of passes compared to continue the open render pass.
const MAX_CANDIDATES: usize = 16;

/// Other orders are not tried if they could save at most the peak divided by this.
const MIN_SAVING_DIVISOR: i64 = 16;

/// Returns the passes that run, in order, and why each is at its position.
///
/// List scheduling: of the ready passes, prefer the one that continues the open render pass, then the one that frees
/// most memory, then the one declared first. This greedy choice can be worse than the order of declaration, or than
/// choosing from the last pass to the first: if one of these needs less memory and no more render passes, it is used.
/// They are not tried if no order could save more than the peak divided by [`MIN_SAVING_DIVISOR`].
pub(super) fn order(
    decl: &Declaration,
    culled: &[Option<CullReason>],
    dependencies: &[Dependency],
) -> (Vec<PassId>, Vec<OrderReason>) {
    let declared: Vec<PassId> = decl.pass_ids().filter(|pass| culled[pass.index()].is_none()).collect();
    if decl.options.order == OrderPolicy::Declared {
        let reasons = vec![OrderReason::Fixed; declared.len()];
        return (declared, reasons);
    }
    let traffic = Traffic::new(decl, &declared);
    let scheduler = |direction| Scheduler::new(decl, &declared, dependencies, &traffic, direction);
    let (order, reasons) = scheduler(Direction::Forwards).run();
    let (peak, pass) = memory::peak(&traffic, &order);
    let least = |pass| memory::min_in_use(&traffic, decl.passes.len(), dependencies, pass);
    let only_order = reasons.iter().all(|reason| *reason == OrderReason::OnlyReady);
    if only_order || pass.is_none_or(|pass| peak - least(pass) <= peak / MIN_SAVING_DIVISOR) {
        return (order, reasons);
    }
    let backwards = scheduler(Direction::Backwards).run().0;
    let backwards = backwards.into_iter().rev().collect();
    let steps = |order: &[PassId]| merge::merge(decl, order).0.len();
    let mut most_steps = None;
    let mut best = (order, None, peak);
    let others =
        [(declared, OrderReason::DeclarationNeedsLess), (backwards, OrderReason::BackwardsNeedsLess)];
    for (other, reason) in others {
        let (peak, _) = memory::peak(&traffic, &other);
        if peak < best.2 && steps(&other) <= *most_steps.get_or_insert_with(|| steps(&best.0)) {
            best = (other, Some(reason), peak);
        }
    }
    let (order, reason, _) = best;
    let reasons = reason.map_or(reasons, |reason| vec![reason; order.len()]);
    (order, reasons)
}

/// The direction in which passes are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Direction {
    /// The first pass first.
    Forwards,
    /// The last pass first.
    Backwards,
}

struct Scheduler<'d> {
    decl: &'d Declaration,
    count: usize,
    /// Passes that depend on each pass.
    successors: Csr<PassId>,
    /// Number of unscheduled dependencies of each pass.
    waiting: Vec<u32>,
    ready: Ready,
    memory: Memory<'d>,
    group: Group,
    direction: Direction,
}

impl<'d> Scheduler<'d> {
    fn new(
        decl: &'d Declaration,
        live: &[PassId],
        dependencies: &[Dependency],
        traffic: &'d Traffic,
        direction: Direction,
    ) -> Self {
        let passes = decl.passes.len();
        let ends = |dependency: &Dependency| match direction {
            Direction::Forwards => (dependency.before, dependency.after),
            Direction::Backwards => (dependency.after, dependency.before),
        };
        let pairs = || dependencies.iter().map(ends);
        let successors = Csr::new(passes, || pairs().map(|(before, after)| (before.index(), after)));
        let mut waiting = vec![0; passes];
        for (_, after) in pairs() {
            waiting[after.index()] += 1;
        }
        let memory = Memory::new(traffic, passes, direction);
        let mut ready = Ready::new(passes, decl.resources.len(), direction);
        for &pass in live.iter().filter(|pass| waiting[pass.index()] == 0) {
            ready.push(decl, pass, memory.score(pass));
        }
        let group = Group::new(decl);
        Self { decl, count: live.len(), successors, waiting, ready, memory, group, direction }
    }

    fn run(mut self) -> (Vec<PassId>, Vec<OrderReason>) {
        let mut order = Vec::with_capacity(self.count);
        let mut reasons = Vec::with_capacity(self.count);
        while let Some((pass, reason)) = self.choose() {
            order.push(pass);
            reasons.push(reason);
            self.ready.remove(pass);
            if self.direction == Direction::Forwards {
                let joins = self.group.can_merge(self.decl, pass) == MergeReason::Merged;
                self.group.add(self.decl, pass, joins);
            }
            let Self { memory, ready, .. } = &mut self;
            memory.run(pass, |other, score| ready.rescore(other, score));
            for &successor in self.successors.row(pass.index()) {
                self.waiting[successor.index()] -= 1;
                if self.waiting[successor.index()] == 0 {
                    self.ready.push(self.decl, successor, self.memory.score(successor));
                }
            }
        }
        (order, reasons)
    }

    fn choose(&mut self) -> Option<(PassId, OrderReason)> {
        if self.ready.len() == 1 {
            return self.ready.pop().map(|(pass, _, _)| (pass, OrderReason::OnlyReady));
        }
        if let Some(pass) = self.continuing() {
            return Some((pass, OrderReason::ContinuesRenderPass));
        }
        let (pass, score, ahead) = self.ready.pop()?;
        let reason = if ahead { OrderReason::FreesMemory(score) } else { OrderReason::DeclaredFirst };
        Some((pass, reason))
    }

    /// Returns the best ready pass that continues the open render pass.
    fn continuing(&mut self) -> Option<PassId> {
        if self.decl.options.order != OrderPolicy::Automatic || !self.decl.options.merge {
            return None;
        }
        let attachment = self.group.attachment(self.decl)?;
        let candidates = self.ready.drawing_into(attachment).take(MAX_CANDIDATES);
        let continues = |pass: &PassId| self.group.can_merge(self.decl, *pass) == MergeReason::Merged;
        let rank = |pass: &PassId| (std::cmp::Reverse(self.memory.score(*pass)), *pass);
        candidates.filter(continues).min_by_key(rank)
    }
}

/// Returns whether a pass is a render pass.
fn is_render_pass(decl: &Declaration, pass: PassId) -> bool {
    decl.pass(pass).kind == PassKind::Render
}
