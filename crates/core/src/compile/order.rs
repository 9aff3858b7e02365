//! In which order passes run.

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

/// Of the passes that could go on with the open render pass, at most so many are compared.
const COMPARED: usize = 16;

/// Less than this part of the peak is not worth the search for another order.
const CLOSE: i64 = 16;

/// Returns the passes that run, in order, and why each stands where it does.
///
/// List scheduling: of the passes whose dependencies are done, the one that goes on with the open render pass, then
/// the one that frees most memory, then the one declared first. Choosing step by step can end worse than it began:
/// where the order of declaration, or choosing from the last pass to the first, needs less memory and no more render
/// passes, that is taken. They are not tried where no order at all could save more than a part in [`CLOSE`].
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
    let scheduler = |time| Scheduler::new(decl, &declared, dependencies, &traffic, time);
    let (order, reasons) = scheduler(Time::Forwards).run();
    let (peak, pass) = memory::peak(&traffic, &order);
    let least = |pass| memory::forced(&traffic, decl.passes.len(), dependencies, pass);
    let forced = reasons.iter().all(|reason| *reason == OrderReason::OnlyReady);
    if forced || pass.is_none_or(|pass| peak - least(pass) <= peak / CLOSE) {
        return (order, reasons);
    }
    let backwards = scheduler(Time::Backwards).run().0;
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

/// Which way passes are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Time {
    /// The first pass first.
    Forwards,
    /// The last pass first.
    Backwards,
}

struct Scheduler<'d> {
    decl: &'d Declaration,
    count: usize,
    /// By pass.
    successors: Csr<PassId>,
    /// By pass: dependencies that are not done.
    waiting: Vec<u32>,
    ready: Ready,
    memory: Memory<'d>,
    group: Group,
    time: Time,
}

impl<'d> Scheduler<'d> {
    fn new(
        decl: &'d Declaration,
        live: &[PassId],
        dependencies: &[Dependency],
        traffic: &'d Traffic,
        time: Time,
    ) -> Self {
        let passes = decl.passes.len();
        let ends = |dependency: &Dependency| match time {
            Time::Forwards => (dependency.before, dependency.after),
            Time::Backwards => (dependency.after, dependency.before),
        };
        let pairs = || dependencies.iter().map(ends);
        let successors = Csr::new(passes, || pairs().map(|(before, after)| (before.index(), after)));
        let mut waiting = vec![0; passes];
        for (_, after) in pairs() {
            waiting[after.index()] += 1;
        }
        let memory = Memory::new(traffic, passes, time);
        let mut ready = Ready::new(passes, decl.resources.len(), time);
        for &pass in live.iter().filter(|pass| waiting[pass.index()] == 0) {
            ready.push(decl, pass, memory.score(pass));
        }
        let group = Group::new(decl);
        Self { decl, count: live.len(), successors, waiting, ready, memory, group, time }
    }

    fn run(mut self) -> (Vec<PassId>, Vec<OrderReason>) {
        let mut order = Vec::with_capacity(self.count);
        let mut reasons = Vec::with_capacity(self.count);
        while let Some((pass, reason)) = self.choose() {
            order.push(pass);
            reasons.push(reason);
            self.ready.take(pass);
            if self.time == Time::Forwards {
                let joins = self.group.judge(self.decl, pass) == MergeReason::Merged;
                self.group.add(self.decl, pass, joins);
            }
            let Self { memory, ready, .. } = &mut self;
            memory.run(pass, |other, score| ready.rescore(other, score));
            for &successor in self.successors.of(pass.index()) {
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

    /// The best ready pass that goes on with the open render pass.
    fn continuing(&mut self) -> Option<PassId> {
        if self.decl.options.order != OrderPolicy::Automatic || !self.decl.options.merge {
            return None;
        }
        let attachment = self.group.attachment(self.decl)?;
        let candidates = self.ready.drawing_into(attachment).take(COMPARED);
        let goes_on = |pass: &PassId| self.group.judge(self.decl, *pass) == MergeReason::Merged;
        let rank = |pass: &PassId| (std::cmp::Reverse(self.memory.score(*pass)), *pass);
        candidates.filter(goes_on).min_by_key(rank)
    }
}

/// Whether a pass can be one of several in a render pass.
fn draws(decl: &Declaration, pass: PassId) -> bool {
    decl.pass(pass).kind == PassKind::Render
}
