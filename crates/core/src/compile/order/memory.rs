//! What running a pass does to the memory in use, forwards or backwards in time.
//!
//! Backwards a resource begins with its last user and ends with its first, and what is exported is there at first.

use super::Time;
use super::traffic::Traffic;
use crate::handle::PassId;
use crate::plan::Dependency;

/// The transient resources that are in use while an order is gone through, and what each pass would change.
pub(super) struct Memory<'t> {
    traffic: &'t Traffic,
    /// By resource.
    states: Vec<State>,
    /// By pass: bytes freed less bytes taken, if it ran now.
    scores: Vec<i64>,
    done: Vec<bool>,
}

#[derive(Clone, Copy)]
struct State {
    /// Passes that touch it and have not run; one more for what is still needed then.
    left: u32,
    alive: bool,
}

/// Before the first pass, or backwards after the last one.
fn states(traffic: &Traffic, time: Time) -> Vec<State> {
    let state = |(resource, &exported): (usize, &bool)| State {
        left: traffic.users(resource).len() as u32 + u32::from(exported && time == Time::Forwards),
        alive: exported && time == Time::Backwards,
    };
    traffic.exported.iter().enumerate().map(state).collect()
}

impl<'t> Memory<'t> {
    pub(super) fn new(traffic: &'t Traffic, passes: usize, time: Time) -> Self {
        let states = states(traffic, time);
        let mut scores = vec![0; passes];
        for (resource, (state, bytes)) in states.iter().zip(&traffic.bytes).enumerate() {
            let freed = if state.left == 1 { *bytes } else { 0 };
            let taken = if state.alive { 0 } else { *bytes };
            for pass in traffic.users(resource) {
                scores[pass.index()] += freed - taken;
            }
        }
        Self { traffic, states, scores, done: vec![false; passes] }
    }

    pub(super) fn score(&self, pass: PassId) -> i64 {
        self.scores[pass.index()]
    }

    /// Runs a pass, and tells `changed` each pass whose score is another now.
    pub(super) fn run(&mut self, pass: PassId, mut changed: impl FnMut(PassId, i64)) {
        self.done[pass.index()] = true;
        for resource in self.traffic.touched(pass) {
            let (bytes, state) = (self.traffic.bytes[resource], &mut self.states[resource]);
            let begins = !std::mem::replace(&mut state.alive, true);
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

/// The greatest number of bytes in use at once if passes run one by one in this order, and the pass that needs them.
pub(super) fn peak(traffic: &Traffic, order: &[PassId]) -> (i64, Option<PassId>) {
    let mut states = states(traffic, Time::Forwards);
    let (mut used, mut peak) = (0, (0, None));
    for &pass in order {
        for resource in traffic.touched(pass) {
            if !std::mem::replace(&mut states[resource].alive, true) {
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

/// Bytes in use while a pass runs in any order: what it touches, and what passes that must come before it leave to
/// passes that must come after it.
pub(super) fn forced(traffic: &Traffic, passes: usize, dependencies: &[Dependency], pass: PassId) -> i64 {
    let (before, after) = around(passes, dependencies, pass);
    let forced = |(resource, bytes): (usize, &i64)| {
        let users = traffic.users(resource);
        let begun = users.iter().any(|&user| user == pass || before[user.index()]);
        let wanted =
            traffic.exported[resource] || users.iter().any(|&user| user == pass || after[user.index()]);
        if begun && wanted { *bytes } else { 0 }
    };
    traffic.bytes.iter().enumerate().map(forced).sum()
}

/// Which passes must come before a pass, and which after it. Dependencies are sorted by the later pass, so one look at
/// each is enough.
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
