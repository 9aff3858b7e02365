//! Faults in which passes run, in which order, and together with which.

use super::{Stage, Work, search};
use crate::compile::tests::oracle::Rule;
use crate::plan::{CullReason, Dependency, MergeReason};
use crate::{DependencyKind, PassId};

/// Returns whether other dependencies put one pass before the other, without this one.
fn implied(work: &Work, without: usize) -> bool {
    let dependencies = &work.plan.dependencies;
    let Dependency { before, after, .. } = dependencies[without];
    let mut reached = vec![before];
    let mut at = 0;
    while at < reached.len() {
        for (index, other) in dependencies.iter().enumerate() {
            if index != without && other.before == reached[at] && !reached.contains(&other.after) {
                reached.push(other.after);
            }
        }
        at += 1;
    }
    reached.contains(&after)
}

#[test]
fn a_lost_dependency() {
    let lose = |stage, work: &mut Work| {
        let dependencies = work.plan.dependencies.len();
        let lost = (stage == Stage::Hazards)
            .then(|| (0..dependencies).rev().find(|&index| !implied(work, index)))?;
        lost.map(|index| work.plan.dependencies.remove(index)).is_some().into()
    };
    search(&[Rule::Dependencies], lose).always_caught();
}

#[test]
fn a_lost_dependency_whose_passes_then_run_in_the_wrong_order() {
    let lose = |stage, work: &mut Work| {
        let dependencies = work.plan.dependencies.len();
        let lost = (stage == Stage::Hazards)
            .then(|| (0..dependencies).rev().find(|&index| !implied(work, index)))?;
        lost.map(|index| work.plan.dependencies.remove(index)).is_some().into()
    };
    search(&[Rule::Hazard], lose).caught(20);
}

#[test]
fn a_lost_explicit_order() {
    let lose = |stage, work: &mut Work| {
        let explicit = |d: &Dependency| d.kind == DependencyKind::Explicit;
        let found = (stage == Stage::Hazards).then(|| work.plan.dependencies.iter().position(explicit))?;
        let alone = found.filter(|&index| !implied(work, index));
        alone.map(|index| work.plan.dependencies.remove(index)).is_some().into()
    };
    search(&[Rule::Dependencies], lose).always_caught();
}

#[test]
fn a_superfluous_dependency() {
    let add = |stage, work: &mut Work| {
        let last = PassId((stage == Stage::Order).then_some(work.plan.decl.passes.len() as u32)? - 1);
        let first = *work.plan.order.first()?;
        let free = !work.plan.dependencies.iter().any(|d| (d.before, d.after) == (first, last));
        let live = work.plan.order.last() == Some(&last) && first != last;
        let (resource, kind) = (None, DependencyKind::Explicit);
        work.plan.dependencies.push(Dependency { before: first, after: last, resource, kind });
        Some(free && live)
    };
    search(&[Rule::Dependencies], add).always_caught();
}

#[test]
fn two_dependent_passes_swapped() {
    let swap = |stage, work: &mut Work| {
        let dependency = (stage == Stage::Order).then(|| work.plan.dependencies.last().copied())?;
        let position = |pass| work.plan.order.iter().position(|&other| other == pass);
        let positions = dependency.map(|d| (position(d.before), position(d.after)));
        let Some((Some(before), Some(after))) = positions else { return Some(false) };
        work.plan.order.swap(before, after);
        Some(true)
    };
    search(&[Rule::Hazard], swap).always_caught();
}

#[test]
fn a_pass_that_runs_twice() {
    let repeat = |stage, work: &mut Work| {
        let first = *(stage == Stage::Order).then(|| work.plan.order.first())??;
        work.plan.order.push(first);
        work.plan.order_reasons.push(work.plan.order_reasons[0]);
        Some(true)
    };
    search(&[Rule::Permutation], repeat).always_caught();
}

#[test]
fn a_culled_pass_that_is_needed() {
    let lose = |stage, work: &mut Work| {
        let live = (stage == Stage::Cull).then(|| work.plan.culled.iter().rposition(Option::is_none))?;
        live.map(|pass| work.plan.culled[pass] = Some(CullReason::WritesNothing)).is_some().into()
    };
    search(&[Rule::Culling], lose).always_caught();
}

#[test]
fn a_pass_that_runs_though_nothing_needs_it() {
    let revive = |stage, work: &mut Work| {
        let culled = (stage == Stage::Cull).then(|| work.plan.culled.iter().position(Option::is_some))?;
        culled.map(|pass| work.plan.culled[pass] = None).is_some().into()
    };
    search(&[Rule::Culling], revive).always_caught();
}

/// Joins the first two steps that were kept apart for such a reason.
fn join(work: &mut Work, apart: impl Fn(MergeReason) -> bool) -> bool {
    let Some(position) = work.plan.merge_reasons.iter().position(|&reason| apart(reason)) else {
        return false;
    };
    let step = work.plan.steps.iter().position(|step| step.0 as usize == position).unwrap_or_default();
    let (_, end) = work.plan.steps.remove(step);
    work.plan.steps[step - 1].1 = end;
    work.plan.merge_reasons[position] = MergeReason::Merged;
    true
}

#[test]
fn a_merge_across_a_hazard() {
    let hazard = |reason| matches!(reason, MergeReason::Reads(..) | MergeReason::Writes(..));
    let merge = |stage, work: &mut Work| (stage == Stage::Merge).then(|| join(work, hazard));
    // Some are not hazards for wgpu: the compiler does not distinguish mips and layers here.
    search(&[Rule::Merging], merge).caught(20);
}

#[test]
fn a_merge_across_a_clear() {
    let clears = |reason| matches!(reason, MergeReason::Clears(_));
    let merge = |stage, work: &mut Work| (stage == Stage::Merge).then(|| join(work, clears));
    search(&[Rule::Merging], merge).always_caught();
}

#[test]
fn a_merge_across_a_resolve() {
    let resolves = |reason| matches!(reason, MergeReason::Resolves(_));
    let merge = |stage, work: &mut Work| (stage == Stage::Merge).then(|| join(work, resolves));
    search(&[Rule::Merging], merge).always_caught();
}

#[test]
fn a_merge_of_passes_with_different_attachments() {
    let differ = |reason| matches!(reason, MergeReason::Attachments);
    let merge = |stage, work: &mut Work| (stage == Stage::Merge).then(|| join(work, differ));
    search(&[Rule::Merging], merge).always_caught();
}

#[test]
fn a_merge_with_a_pass_that_does_not_draw() {
    let kind = |reason| matches!(reason, MergeReason::Kind(_) | MergeReason::KindBefore(_));
    let merge = |stage, work: &mut Work| (stage == Stage::Merge).then(|| join(work, kind));
    search(&[Rule::Merging], merge).always_caught();
}
