//! Expected contents of every access: passes run one by one as declared, each resource in separate memory.

use super::super::frames::Cells;
use super::Model;
use crate::Origin;

/// The contents of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Stamp {
    Undefined,
    /// Contents from before the frame.
    Initial,
    /// Contents written by this access of this pass.
    Written(usize, usize),
}

/// An access that needs undefined contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Invalid {
    Read,
    Preserve,
}

impl Invalid {
    /// Code of its error.
    pub(in super::super) fn code(self) -> &'static str {
        match self {
            Self::Read => "SG0201",
            Self::Preserve => "SG0202",
        }
    }
}

/// The contents when passes run in the order of declaration.
pub(in super::super) struct Truth {
    /// Contents of each cell before the pass, for each pass and access that needs them.
    pub(super) needs: Vec<Vec<Vec<(usize, Stamp)>>>,
    /// Contents of each cell at the end, by resource.
    pub(super) finals: Vec<Vec<Stamp>>,
    pub(in super::super) invalid: Option<Invalid>,
}

impl Truth {
    pub(in super::super) fn new(model: &Model<'_>) -> Self {
        let finals = (0..model.spec.resources.len()).map(|resource| initial(model, resource)).collect();
        let mut truth = Self { needs: Vec::new(), finals, invalid: None };
        for pass in 0..model.spec.passes.len() {
            let accesses = model.accesses(pass);
            let needs = accesses.map(|(_, access, cells)| match access.needs() {
                true => truth.find(access.resource, &cells),
                false => Vec::new(),
            });
            let needs = needs.collect();
            truth.needs.push(needs);
            truth.find_invalid(model, pass);
            for (index, access, cells) in model.accesses(pass).filter(|(_, access, _)| access.writes()) {
                cells
                    .iter()
                    .for_each(|cell| truth.finals[access.resource][cell] = Stamp::Written(pass, index));
            }
        }
        for (resource, left) in truth.finals.iter().enumerate() {
            let kept = model.spec.is_exported(resource)
                || matches!(model.spec.resources[resource].origin, Origin::Current { .. });
            if kept && left.contains(&Stamp::Undefined) {
                truth.invalid = truth.invalid.or(Some(Invalid::Read));
            }
        }
        truth
    }

    fn find(&self, resource: usize, cells: &Cells) -> Vec<(usize, Stamp)> {
        cells.iter().map(|cell| (cell, self.finals[resource][cell])).collect()
    }

    fn find_invalid(&mut self, model: &Model<'_>, pass: usize) {
        let undefined =
            |needs: &Vec<(usize, Stamp)>| needs.iter().any(|(_, stamp)| *stamp == Stamp::Undefined);
        let Some(index) = self.needs[pass].iter().position(undefined) else { return };
        let reads = !model.spec.passes[pass].accesses[index].writes();
        self.invalid = self.invalid.or(Some(if reads { Invalid::Read } else { Invalid::Preserve }));
    }
}

pub(super) fn initial(model: &Model<'_>, resource: usize) -> Vec<Stamp> {
    let stamp = match model.spec.resources[resource].origin {
        Origin::Imported { defined: true } | Origin::Previous { .. } => Stamp::Initial,
        _ => Stamp::Undefined,
    };
    vec![stamp; model.cells[resource].len()]
}
