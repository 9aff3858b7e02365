//! A naive oracle of plans: it knows the rules of the graph and nothing of the compiler.
//!
//! It believes the spec, not the declaration, looks at every texel and byte, and compares everything with
//! everything. Like `frames` it uses the crate's public names only.

mod culling;
mod declared;
mod live;
mod memory;
mod merging;
mod ordering;
mod reasons;
mod replay;
mod slots;
mod truth;
mod usages;

pub(super) use live::Live;
pub(super) use memory::{lower_bounds, peak_of};
pub(super) use truth::Truth;

use super::frames::{AccessSpec, Cell, Cells, Names, Spec, cells_of};
use crate::{PassId, Plan, ResourceDesc};

/// The rules of a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// The plan contains what was declared.
    Declared,
    /// The order is a permutation of the passes that run.
    Permutation,
    /// Conflicting accesses keep their order, and so do passes with an explicit order.
    Hazard,
    /// The listed dependencies are true, and imply every hazard.
    Dependencies,
    /// Passes run if and only if a root needs them.
    Culling,
    /// Passes share a render pass only where no hazard forbids it.
    Merging,
    /// Every access finds its expected contents.
    Contents,
    /// Resources that outlive the frame have the written contents.
    Survival,
    /// There is no unnecessary load or store.
    Waste,
    /// Lifetimes of resources in a slot do not overlap, and the slot fits them.
    Slots,
    /// Usages are exactly those that accesses need.
    Usages,
    /// Transient attachments are valid, and used wherever they are.
    TransientAttachment,
    /// Reasons are true.
    Reasons,
}

/// A broken rule.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Breach {
    pub(super) rule: Rule,
    pub(super) message: String,
}

/// Checks a plan against the spec of its frame, which must be valid.
pub(super) fn check_plan(spec: &Spec, names: &Names, plan: &Plan) -> Vec<Breach> {
    let mut oracle = Oracle { model: Model::new(spec), breaches: Vec::new() };
    oracle.declared(names, plan);
    if !oracle.breaches.is_empty() {
        return oracle.breaches;
    }
    let truth = Truth::new(&oracle.model);
    oracle.culling(&truth, plan);
    // The following checks need a valid order.
    if !oracle.permutation(plan) {
        return oracle.breaches;
    }
    let live = Live::new(&oracle.model, plan);
    oracle.ordering(names, plan, &live);
    oracle.merging(plan, &live);
    oracle.slots(names, plan, &live);
    oracle.usages(names, plan, &live);
    if oracle.breaches.iter().all(|breach| breach.rule != Rule::Slots) {
        oracle.replay(&truth, plan, names, &live);
    }
    oracle.reasons(names, plan, &live);
    oracle.breaches
}

/// A spec with all of its cells.
pub(super) struct Model<'s> {
    pub(super) spec: &'s Spec,
    /// Cells of each resource.
    pub(super) cells: Vec<Vec<Cell>>,
    /// Cells of each access, by pass.
    parts: Vec<Vec<Cells>>,
    /// Passes that must run before each pass.
    before: Vec<Vec<bool>>,
}

impl<'s> Model<'s> {
    pub(super) fn new(spec: &'s Spec) -> Self {
        let cells: Vec<Vec<Cell>> = spec.resources.iter().map(|resource| cells_of(&resource.desc)).collect();
        let parts = spec.passes.iter().map(|pass| {
            pass.accesses.iter().map(|access| access.subresource.cells(&cells[access.resource])).collect()
        });
        let parts = parts.collect();
        let mut model = Self { spec, cells, parts, before: Vec::new() };
        model.before = (0..spec.passes.len())
            .map(|later| (0..later).map(|earlier| model.must_follow(earlier, later)).collect())
            .collect();
        model
    }

    fn whole(&self, resource: usize) -> Cells {
        Cells::first(self.cells[resource].len())
    }

    fn accesses(&self, pass: usize) -> impl DoubleEndedIterator<Item = (usize, &'s AccessSpec, Cells)> + '_ {
        let accesses = self.spec.passes[pass].accesses.iter().enumerate();
        accesses.map(move |(index, access)| (index, access, self.parts[pass][index]))
    }

    /// Returns what an attachment loads and stores: all of its mip and layer, of the aspects that it has.
    fn attachment(&self, access: &AccessSpec) -> Cells {
        access.subresource.without_rect().cells(&self.cells[access.resource])
    }

    /// Returns what a discarded attachment loses: for a volume every slice.
    fn discarded(&self, access: &AccessSpec) -> Cells {
        let whole = access.subresource.without_rect();
        let whole = match self.spec.desc(access.resource) {
            ResourceDesc::Texture(desc) => whole.with_all_slices(desc),
            ResourceDesc::Buffer(_) => whole,
        };
        whole.cells(&self.cells[access.resource])
    }

    /// Returns what wgpu tracks together with an access of a shader within one pass.
    fn subresources(&self, access: &AccessSpec) -> Cells {
        match self.spec.desc(access.resource) {
            ResourceDesc::Texture(desc) => {
                access.subresource.tracked(desc).cells(&self.cells[access.resource])
            }
            ResourceDesc::Buffer(_) => self.whole(access.resource),
        }
    }

    /// Returns whether the later of two passes must run after the earlier.
    pub(super) fn ordered(&self, earlier: usize, later: usize) -> bool {
        self.before[later][earlier]
    }

    /// Returns whether two passes use the same cells and one of them writes, or have an explicit order.
    fn must_follow(&self, earlier: usize, later: usize) -> bool {
        let conflict = self.accesses(earlier).any(|(_, first, own)| {
            let clash = |(_, second, other): (usize, &AccessSpec, Cells)| {
                first.resource == second.resource
                    && (first.writes() || second.writes())
                    && own.overlaps(&other)
            };
            self.accesses(later).any(clash)
        });
        conflict || self.spec.passes[later].after.contains(&earlier)
    }
}

struct Oracle<'s> {
    model: Model<'s>,
    breaches: Vec<Breach>,
}

impl Oracle<'_> {
    fn report(&mut self, rule: Rule, message: impl Into<String>) {
        self.breaches.push(Breach { rule, message: message.into() });
    }

    fn expect(&mut self, holds: bool, rule: Rule, message: impl FnOnce() -> String) {
        if !holds {
            self.report(rule, message());
        }
    }
}

/// Ids of the plan as indices in the spec.
pub(super) fn spec_pass(id: PassId) -> usize {
    id.index()
}

/// Returns whether an access is to all of its resource.
pub(super) fn part_is_whole(spec: &Spec, access: &AccessSpec) -> bool {
    let cells = cells_of(spec.desc(access.resource));
    access.subresource.cells(&cells) == Cells::first(cells.len())
}
