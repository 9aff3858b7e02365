//! The passes that are ready, the best one first.

use super::{Time, draws};
use crate::declaration::Declaration;
use crate::handle::{PassId, ResourceId};
use std::collections::BinaryHeap;

const NONE: u32 = u32::MAX;

/// Ready passes by score, then by declaration, the first declared first (backwards the last). A pass whose score
/// changes is entered again; what is out of date is passed over.
pub(super) struct Ready {
    heap: BinaryHeap<(i64, Rank)>,
    time: Time,
    /// By pass: its present score while it is ready.
    scores: Vec<Option<i64>>,
    count: usize,
    /// By resource: the ready render passes whose first attachment it is, as a list through `links`.
    drawing: Vec<Ends>,
    /// By pass.
    links: Vec<Link>,
}

/// A pass by its place: the greatest goes first.
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
    pub(super) fn new(passes: usize, resources: usize, time: Time) -> Self {
        Self {
            heap: BinaryHeap::with_capacity(16),
            time,
            scores: vec![None; passes],
            count: 0,
            drawing: vec![Ends { first: NONE, last: NONE }; resources],
            links: vec![Link { previous: NONE, next: NONE, resource: NONE }; passes],
        }
    }

    /// Counts down forwards and up backwards. It is its own inverse.
    fn rank(&self, place: u32) -> u32 {
        match self.time {
            Time::Forwards => u32::MAX - place,
            Time::Backwards => place,
        }
    }

    fn enter(&mut self, pass: PassId, score: i64) {
        let rank = Rank(self.rank(pass.0));
        self.heap.push((score, rank));
    }

    pub(super) fn len(&self) -> usize {
        self.count
    }

    pub(super) fn push(&mut self, decl: &Declaration, pass: PassId, score: i64) {
        self.scores[pass.index()] = Some(score);
        self.enter(pass, score);
        self.count += 1;
        let attachment = decl.pass(pass).attachment;
        if let (true, Some(resource)) = (draws(decl, pass), attachment) {
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
            self.enter(pass, score);
        }
    }

    /// Takes a pass out, since it runs.
    pub(super) fn take(&mut self, pass: PassId) {
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

    /// Takes the best pass off the heap, with its score, and whether it is better than every other by more than its
    /// place.
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

    /// The ready render passes whose first attachment is `resource`, the first to become ready first.
    pub(super) fn drawing_into(&self, resource: ResourceId) -> impl Iterator<Item = PassId> {
        let listed = |at: u32| (at != NONE).then_some(at);
        let first = listed(self.drawing[resource.index()].first);
        std::iter::successors(first, move |&at| listed(self.links[at as usize].next)).map(PassId)
    }
}
