//! The ready passes, the best one first.

use super::{Direction, is_render_pass};
use crate::declaration::Declaration;
use crate::handle::{PassId, ResourceId};
use std::collections::BinaryHeap;

const NONE: u32 = u32::MAX;

/// Ready passes by score, then by declaration, the first declared first (backwards the last). A pass whose score
/// changes is pushed again; outdated entries are skipped.
pub(super) struct Ready {
    heap: BinaryHeap<(i64, Rank)>,
    direction: Direction,
    /// Current score of each ready pass.
    scores: Vec<Option<i64>>,
    count: usize,
    /// Ready render passes with each resource as first attachment, as lists through `links`.
    drawing: Vec<Ends>,
    /// Neighbours of each pass in its list.
    links: Vec<Link>,
}

/// The rank of a pass among equal scores: the greatest goes first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Rank(u32);

#[derive(Clone, Copy)]
struct Ends {
    first: u32,
    last: u32,
}

/// The neighbours of a pass in the list of `resource`.
#[derive(Clone, Copy)]
struct Link {
    previous: u32,
    next: u32,
    resource: u32,
}

impl Ready {
    pub(super) fn new(passes: usize, resources: usize, direction: Direction) -> Self {
        Self {
            heap: BinaryHeap::with_capacity(16),
            direction,
            scores: vec![None; passes],
            count: 0,
            drawing: vec![Ends { first: NONE, last: NONE }; resources],
            links: vec![Link { previous: NONE, next: NONE, resource: NONE }; passes],
        }
    }

    /// Returns the rank of a pass index: descending forwards, ascending backwards. It is its own inverse.
    fn rank(&self, index: u32) -> u32 {
        match self.direction {
            Direction::Forwards => u32::MAX - index,
            Direction::Backwards => index,
        }
    }

    fn push_entry(&mut self, pass: PassId, score: i64) {
        let rank = Rank(self.rank(pass.0));
        self.heap.push((score, rank));
    }

    pub(super) fn len(&self) -> usize {
        self.count
    }

    pub(super) fn push(&mut self, decl: &Declaration, pass: PassId, score: i64) {
        self.scores[pass.index()] = Some(score);
        self.push_entry(pass, score);
        self.count += 1;
        let attachment = decl.pass(pass).attachment;
        if let (true, Some(resource)) = (is_render_pass(decl, pass), attachment) {
            let ends = &mut self.drawing[resource.index()];
            let previous = std::mem::replace(&mut ends.last, pass.0);
            match previous {
                NONE => ends.first = pass.0,
                previous => self.links[previous as usize].next = pass.0,
            }
            self.links[pass.index()] = Link { previous, next: NONE, resource: resource.0 };
        }
    }

    pub(super) fn rescore(&mut self, pass: PassId, score: i64) {
        if let Some(own) = &mut self.scores[pass.index()]
            && *own != score
        {
            *own = score;
            self.push_entry(pass, score);
        }
    }

    /// Removes a pass that was scheduled.
    pub(super) fn remove(&mut self, pass: PassId) {
        let index = pass.index();
        if self.scores[index].take().is_none() {
            return;
        }
        self.count -= 1;
        let Link { previous, next, resource } = self.links[index];
        if resource == NONE {
            return;
        }
        let ends = &mut self.drawing[resource as usize];
        match previous {
            NONE => ends.first = next,
            previous => self.links[previous as usize].next = next,
        }
        match next {
            NONE => ends.last = previous,
            next => self.links[next as usize].previous = previous,
        }
    }

    /// Pops the best pass with its score, and whether its score is better than that of every other.
    pub(super) fn pop(&mut self) -> Option<(PassId, i64, bool)> {
        self.drop_outdated();
        let (score, rank) = self.heap.pop()?;
        self.drop_outdated();
        let ahead = self.heap.peek().is_none_or(|&(second, _)| second < score);
        Some((PassId(self.rank(rank.0)), score, ahead))
    }

    fn drop_outdated(&mut self) {
        while let Some(&(score, rank)) = self.heap.peek()
            && self.scores[self.rank(rank.0) as usize] != Some(score)
        {
            self.heap.pop();
        }
    }

    /// Returns the ready render passes whose first attachment is `resource`, in the order in which they became ready.
    pub(super) fn drawing_into(&self, resource: ResourceId) -> impl Iterator<Item = PassId> {
        let listed = |at: u32| (at != NONE).then_some(at);
        let first = listed(self.drawing[resource.index()].first);
        std::iter::successors(first, move |&at| listed(self.links[at as usize].next)).map(PassId)
    }
}
