//! Execution of the plan on slots that still hold the contents of the previous resource.

use super::super::frames::{AccessSpec, Cells, Names};
use super::truth::{Stamp, Truth, initial};
use super::{Live, Oracle, Rule, spec_pass};
use crate::{Aspect, AttachmentOps, ClearValue, Contents, LoadAction, Plan, ResourceDesc, StoreAction};

/// The contents of a cell of a slot.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Content {
    /// Undefined contents.
    Garbage,
    /// The contents of a cell of this resource.
    Of(usize, Stamp),
    /// A clear value, as its bits.
    Cleared([u64; 4]),
}

/// An attachment whose render pass is open: the resource and the cells.
type Open = (usize, Cells);

struct Replay<'p> {
    plan: &'p Plan,
    live: &'p Live,
    truth: &'p Truth,
    /// The memory of each slot, then of each resource that has its own.
    memory: Vec<Vec<Content>>,
    /// Memory of each resource.
    homes: Vec<usize>,
    /// Expected contents of the cells of each resource.
    stamps: Vec<Vec<Stamp>>,
    open: Vec<Open>,
}

impl Oracle<'_> {
    pub(super) fn replay(&mut self, truth: &Truth, plan: &Plan, names: &Names, live: &Live) {
        let mut replay = self.memory(truth, plan, names, live);
        for (position, &pass) in live.order.iter().enumerate() {
            self.run(&mut replay, position, pass);
            let ends = live.steps.get(position + 1) != Some(&live.steps[position]);
            if ends {
                let left = std::mem::take(&mut replay.open);
                self.expect(left.is_empty(), Rule::Contents, || format!("{left:?} stay open after p{pass}"));
            }
        }
        for resource in
            (0..self.model.spec.resources.len()).filter(|&resource| self.model.spec.outlives(resource))
        {
            let held = &replay.memory[replay.homes[resource]];
            let kept = truth.finals[resource].iter().zip(held).all(|(&stamp, &content)| {
                stamp == Stamp::Undefined || content == Content::Of(resource, stamp)
            });
            self.expect(kept, Rule::Survival, || format!("r{resource} holds {held:?} in the end"));
        }
    }

    fn memory<'p>(&self, truth: &'p Truth, plan: &'p Plan, names: &Names, live: &'p Live) -> Replay<'p> {
        let longest = self.model.cells.iter().map(Vec::len).max().unwrap_or(0);
        let slot = |desc: &ResourceDesc| match desc {
            ResourceDesc::Texture(_) => vec![Content::Garbage; longest],
            ResourceDesc::Buffer(desc) => vec![Content::Garbage; (desc.bytes / 8) as usize],
        };
        let mut memory: Vec<Vec<Content>> = plan.slots().map(|own| slot(&own.desc)).collect();
        let mut homes = Vec::new();
        for resource in 0..self.model.spec.resources.len() {
            homes.push(match plan.resource(names.id(resource)).slot {
                Some(slot) => slot.index(),
                None => {
                    let stamps = initial(&self.model, resource);
                    let content = |stamp: Stamp| match stamp {
                        Stamp::Undefined => Content::Garbage,
                        stamp => Content::Of(resource, stamp),
                    };
                    memory.push(stamps.into_iter().map(content).collect());
                    memory.len() - 1
                }
            });
        }
        let stamps = (0..homes.len()).map(|resource| initial(&self.model, resource)).collect();
        Replay { plan, live, truth, memory, homes, stamps, open: Vec::new() }
    }

    /// Begins the pass, lets it read, then write, and ends it.
    fn run(&mut self, replay: &mut Replay<'_>, position: usize, pass: usize) {
        let id = replay.plan.order()[position];
        assert_eq!(spec_pass(id), pass);
        let ops: Vec<Option<AttachmentOps>> = replay.plan.accesses(id).map(|access| access.ops).collect();
        let accesses: Vec<_> = self.model.accesses(pass).map(|(_, access, cells)| (*access, cells)).collect();
        for ((access, cells), ops) in accesses.iter().zip(&ops) {
            self.expect(access.drawn() == ops.is_some(), Rule::Contents, || {
                format!("p{pass} has {ops:?} for {access:?}")
            });
            if let Some(ops) = ops {
                self.begin(replay, position, access, cells, ops);
            }
        }
        for (index, (access, cells)) in accesses.iter().enumerate() {
            self.find(replay, (pass, index), access, cells);
        }
        for (index, (access, cells)) in accesses.iter().enumerate().filter(|(_, (access, _))| access.writes())
        {
            let stamp = Stamp::Written(pass, index);
            for cell in cells.iter() {
                replay.memory[replay.homes[access.resource]][cell] = Content::Of(access.resource, stamp);
                replay.stamps[access.resource][cell] = stamp;
            }
        }
        for ((access, _), ops) in accesses.iter().zip(&ops) {
            if let Some(ops) = ops {
                self.end(replay, position, access, ops);
            }
        }
    }

    /// Loads an attachment, or continues it.
    fn begin(
        &mut self,
        replay: &mut Replay<'_>,
        position: usize,
        access: &AccessSpec,
        subresource: &Cells,
        ops: &AttachmentOps,
    ) {
        let (resource, whole) = (access.resource, self.model.attachment(access));
        let open = replay.open.contains(&(resource, whole));
        let continues = ops.load == LoadAction::Continue;
        self.expect(open == continues, Rule::Contents, || {
            format!("position {position} has {ops:?} for {access:?}")
        });
        if !open {
            replay.open.push((resource, whole));
        }
        match ops.load {
            LoadAction::Clear(value) => self.fill(replay, resource, &whole, value),
            LoadAction::Load => {
                let wanted = self.wanted(replay, resource, &whole, self.step_start(replay, position));
                self.expect(wanted, Rule::Waste, || {
                    format!("position {position} loads r{resource} for nothing")
                });
            }
            LoadAction::Continue => {}
        }
        if let (Some(Contents::Clear(value)), true) = (access.contents, ops.clear_drawn) {
            self.fill(replay, resource, subresource, value);
        }
    }

    fn step_start(&self, replay: &Replay<'_>, position: usize) -> usize {
        let step = replay.live.steps[position];
        replay.live.steps.iter().position(|&other| other == step).unwrap_or(position)
    }

    fn fill(&self, replay: &mut Replay<'_>, resource: usize, cells: &Cells, value: ClearValue) {
        let home = replay.homes[resource];
        for cell in cells.iter() {
            replay.memory[home][cell] = cleared(value, self.model.cells[resource][cell].aspect);
        }
    }

    /// Checks that an access finds what it needs, or cleared contents.
    fn find(
        &mut self,
        replay: &Replay<'_>,
        (pass, index): (usize, usize),
        access: &AccessSpec,
        cells: &Cells,
    ) {
        let (resource, memory) = (access.resource, &replay.memory[replay.homes[access.resource]]);
        for &(cell, stamp) in &replay.truth.needs[pass][index] {
            let found = memory[cell];
            self.expect(found == Content::Of(resource, stamp), Rule::Contents, || {
                format!("p{pass} finds {found:?} in cell {cell} of r{resource}, not {stamp:?}")
            });
        }
        if let Some(Contents::Clear(value)) = access.contents {
            let wrong = cells
                .iter()
                .find(|&cell| memory[cell] != cleared(value, self.model.cells[resource][cell].aspect));
            self.expect(wrong.is_none(), Rule::Contents, || {
                format!("p{pass} wants r{resource} cleared, and cell {wrong:?} is not")
            });
        }
    }

    /// Stores an attachment, or discards it.
    fn end(&mut self, replay: &mut Replay<'_>, position: usize, access: &AccessSpec, ops: &AttachmentOps) {
        let (resource, whole) = (access.resource, self.model.attachment(access));
        if ops.store == StoreAction::Continue {
            return;
        }
        replay.open.retain(|open| *open != (resource, whole));
        let together = self.model.discarded(access);
        if ops.store == StoreAction::Discard {
            let home = replay.homes[resource];
            together.iter().for_each(|cell| replay.memory[home][cell] = Content::Garbage);
        } else {
            let wanted = self.wanted(replay, resource, &together, position + 1);
            self.expect(wanted, Rule::Waste, || {
                format!("position {position} stores r{resource} for nothing")
            });
        }
    }

    /// Returns whether anything from this position on needs the contents of these cells.
    fn wanted(&self, replay: &Replay<'_>, resource: usize, cells: &Cells, from: usize) -> bool {
        let defined = cells.iter().filter(|&cell| replay.stamps[resource][cell] != Stamp::Undefined);
        let mut defined = defined;
        defined.any(|cell| {
            for &pass in &replay.live.order[from..] {
                let touches = self.model.accesses(pass);
                let mut touches =
                    touches.filter(|(_, a, own)| a.resource == resource && own.contains(cell)).peekable();
                if touches.peek().is_some() {
                    return touches.any(|(_, access, _)| access.needs());
                }
            }
            self.model.spec.outlives(resource)
        })
    }
}

fn cleared(value: ClearValue, aspect: Aspect) -> Content {
    Content::Cleared(match (value, aspect) {
        (ClearValue::Color(rgba), _) => rgba.map(f64::to_bits),
        (ClearValue::Depth(_), Aspect::Stencil) => [0; 4],
        (ClearValue::DepthStencil(_, stencil), Aspect::Stencil) => [stencil.into(), 0, 0, 0],
        (ClearValue::Depth(depth) | ClearValue::DepthStencil(depth, _), _) => {
            [depth.to_bits().into(), 0, 0, 0]
        }
    })
}
