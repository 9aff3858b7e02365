//! The change of the memory in use when a pass runs, forwards or backwards.
//!
//! Backwards, a resource begins with its last user and ends with its first, and exports exist from the start.

use super::Direction;
use super::traffic::Traffic;
use crate::handle::PassId;
use crate::plan::Dependency;

/// The transient resources in use while passes are scheduled, and the score of each pass.
pub(super) struct Memory<'t> {
    traffic: &'t Traffic,
    /// State of each resource.
    states: Vec<State>,
    /// Bytes freed minus bytes allocated by each pass if it ran next.
    scores: Vec<i64>,
    done: Vec<bool>,
}

#[derive(Clone, Copy)]
struct State {
    /// Number of its users that have not run, plus one if it is needed after them.
    left: u32,
    is_live: bool,
}

/// Returns the states before the first pass, or backwards after the last one.
fn states(traffic: &Traffic, direction: Direction) -> Vec<State> {
    let state = |(resource, &exported): (usize, &bool)| State {
        left: traffic.users(resource).len() as u32 + u32::from(exported && direction == Direction::Forwards),
        is_live: exported && direction == Direction::Backwards,
    };
    traffic.exported.iter().enumerate().map(state).collect()
}

impl<'t> Memory<'t> {
    pub(super) fn new(traffic: &'t Traffic, passes: usize, direction: Direction) -> Self {
        let states = states(traffic, direction);
        let mut scores = vec![0; passes];
        for (resource, (state, bytes)) in states.iter().zip(&traffic.bytes).enumerate() {
            let freed = if state.left == 1 { *bytes } else { 0 };
            let taken = if state.is_live { 0 } else { *bytes };
            for pass in traffic.users(resource) {
                scores[pass.index()] += freed - taken;
            }
        }
        Self { traffic, states, scores, done: vec![false; passes] }
    }

    pub(super) fn score(&self, pass: PassId) -> i64 {
        self.scores[pass.index()]
    }

    /// Runs a pass, and calls `changed` for each pass whose score changes.
    pub(super) fn run(&mut self, pass: PassId, mut changed: impl FnMut(PassId, i64)) {
        self.done[pass.index()] = true;
        for resource in self.traffic.touched(pass) {
            let (bytes, state) = (self.traffic.bytes[resource], &mut self.states[resource]);
            let begins = !std::mem::replace(&mut state.is_live, true);
            state.left -= 1;
            let gain = bytes * (i64::from(begins) + i64::from(state.left == 1));
            if gain == 0 {
                continue;
            }
            for &user in self.traffic.users(resource) {
                if !self.done[user.index()] {
                    self.scores[user.index()] += gain;
                    changed(user, self.scores[user.index()]);
                }
            }
        }
    }
}

/// Returns the peak of bytes in use if passes run in this order, and the pass at the peak.
pub(super) fn peak(traffic: &Traffic, order: &[PassId]) -> (i64, Option<PassId>) {
    let mut states = states(traffic, Direction::Forwards);
    let (mut used, mut peak) = (0, (0, None));
    for &pass in order {
        for resource in traffic.touched(pass) {
            if !std::mem::replace(&mut states[resource].is_live, true) {
                used += traffic.bytes[resource];
            }
        }
        if used > peak.0 {
            peak = (used, Some(pass));
        }
        for resource in traffic.touched(pass) {
            states[resource].left -= 1;
            if states[resource].left == 0 {
                used -= traffic.bytes[resource];
            }
        }
    }
    peak
}

/// Returns the bytes that are in use while a pass runs, whatever the order: what it uses, and what passes that must
/// precede it leave to passes that must follow it.
pub(super) fn min_in_use(traffic: &Traffic, passes: usize, dependencies: &[Dependency], pass: PassId) -> i64 {
    let (before, after) = around(passes, dependencies, pass);
    let in_use = |(resource, bytes): (usize, &i64)| {
        let users = traffic.users(resource);
        let is_begun = users.iter().any(|&user| user == pass || before[user.index()]);
        let is_needed =
            traffic.exported[resource] || users.iter().any(|&user| user == pass || after[user.index()]);
        if is_begun && is_needed { *bytes } else { 0 }
    };
    traffic.bytes.iter().enumerate().map(in_use).sum()
}

/// Returns which passes must precede a pass, and which must follow it. Dependencies are sorted by the later pass, so one
/// iteration is enough.
fn around(passes: usize, dependencies: &[Dependency], pass: PassId) -> (Vec<bool>, Vec<bool>) {
    let (mut before, mut after) = (vec![false; passes], vec![false; passes]);
    for dependency in dependencies.iter().rev() {
        let leads = dependency.after == pass || before[dependency.after.index()];
        before[dependency.before.index()] |= leads;
    }
    for dependency in dependencies {
        let follows = dependency.before == pass || after[dependency.before.index()];
        after[dependency.after.index()] |= follows;
    }
    (before, after)
}
