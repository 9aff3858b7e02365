//! What running a pass does to the memory in use, forwards or backwards in time.
//!
//! Backwards a resource begins with its last user and ends with its first, and what is exported is there at first.

use super::Time;
use crate::compile::lists::Lists;
use crate::declaration::{Declaration, Origin, ResourceDecl};
use crate::handle::PassId;
use crate::plan::Dependency;

/// The transient resources that are in use while an order is gone through, and what each pass would change.
pub(super) struct Memory<'d> {
    decl: &'d Declaration,
    /// By resource; 0 for what takes no slot.
    bytes: &'d [i64],
    /// By resource.
    states: Vec<State>,
    /// By resource that takes a slot: the passes that touch it, in order. Those that do so twice stand there twice.
    users: Lists<PassId>,
    /// By pass: bytes freed less bytes taken, if it ran now.
    scores: Vec<i64>,
    done: Vec<bool>,
}

#[derive(Clone, Copy)]
struct State {
    /// Passes that touch it and have not run; one more for what is still needed then.
    left: u32,
    alive: bool,
    /// The pass that touched it last.
    toucher: Option<PassId>,
}

impl<'d> Memory<'d> {
    /// `live` is in order of declaration.
    pub(super) fn new(decl: &'d Declaration, live: &[PassId], bytes: &'d [i64], time: Time) -> Self {
        let of_pass =
            |&pass: &PassId| decl.accesses(pass).iter().map(move |access| (access.resource.index(), pass));
        let users = Lists::new(bytes.len(), || live.iter().flat_map(of_pass).filter(|&(r, _)| bytes[r] != 0));
        let mut scores = vec![0; decl.passes.len()];
        let state = |(index, resource): (usize, &ResourceDecl)| {
            let (bytes, users, exported) = (bytes[index], users.of(index), resource.exported.is_some());
            let left = once(users).count() as u32 + u32::from(exported && time == Time::Forwards);
            let alive = exported && time == Time::Backwards;
            let freed = if left == 1 { bytes } else { 0 };
            let taken = if alive { 0 } else { bytes };
            for pass in once(users) {
                scores[pass.index()] += freed - taken;
            }
            State { left, alive, toucher: None }
        };
        let states = decl.resources.iter().enumerate().map(state).collect();
        Self { decl, bytes, states, users, scores, done: vec![false; decl.passes.len()] }
    }

    pub(super) fn score(&self, pass: PassId) -> i64 {
        self.scores[pass.index()]
    }

    /// Runs a pass, and tells `changed` each pass whose score is another now.
    pub(super) fn run(&mut self, pass: PassId, mut changed: impl FnMut(PassId, i64)) {
        self.done[pass.index()] = true;
        for access in self.decl.accesses(pass) {
            let resource = access.resource.index();
            let (bytes, state) = (self.bytes[resource], &mut self.states[resource]);
            // A pass that touches a resource twice counts once.
            if bytes == 0 || state.toucher.replace(pass) == Some(pass) {
                continue;
            }
            let mut gain = 0;
            if !std::mem::replace(&mut state.alive, true) {
                gain += bytes;
            }
            state.left -= 1;
            if state.left == 1 {
                gain += bytes;
            }
            if gain == 0 {
                continue;
            }
            for user in once(self.users.of(resource)) {
                if !self.done[user.index()] {
                    self.scores[user.index()] += gain;
                    changed(user, self.scores[user.index()]);
                }
            }
        }
    }
}

/// The passes of an ordered list, each once.
fn once(passes: &[PassId]) -> impl Iterator<Item = PassId> {
    passes.chunk_by(|a, b| a == b).map(|same| same[0])
}

/// Bytes of what takes a slot, by resource; 0 for all else.
pub(super) fn bytes(decl: &Declaration) -> Vec<i64> {
    let transient = |origin: Origin| origin == Origin::Transient;
    let bytes = decl.resources.iter().map(|r| if transient(r.origin) { r.desc.bytes() } else { 0 });
    bytes.map(|bytes| i64::try_from(bytes).unwrap_or(i64::MAX)).collect()
}

/// The greatest number of bytes in use at once if passes run one by one in this order, and the pass that needs them.
pub(super) fn peak(decl: &Declaration, bytes: &[i64], order: &[PassId]) -> (i64, Option<PassId>) {
    const NEVER: u32 = u32::MAX;
    let mut last_use = vec![NEVER; bytes.len()];
    for (place, &pass) in order.iter().enumerate() {
        for access in decl.accesses(pass) {
            last_use[access.resource.index()] = place as u32;
        }
    }
    let mut alive = vec![false; bytes.len()];
    let (mut used, mut peak) = (0, (0, None));
    for (place, &pass) in order.iter().enumerate() {
        for access in decl.accesses(pass) {
            let index = access.resource.index();
            if !std::mem::replace(&mut alive[index], true) {
                used += bytes[index];
            }
        }
        if used > peak.0 {
            peak = (used, Some(pass));
        }
        for access in decl.accesses(pass) {
            let index = access.resource.index();
            if last_use[index] == place as u32 && decl.resources[index].exported.is_none() {
                used -= bytes[index];
                // Counted once, though a pass may touch it twice.
                last_use[index] = NEVER;
            }
        }
    }
    peak
}

/// Bytes in use while a pass runs in any order: what it touches, and what passes that must come before it leave to
/// passes that must come after it.
pub(super) fn forced(
    decl: &Declaration,
    bytes: &[i64],
    live: &[PassId],
    dependencies: &[Dependency],
    pass: PassId,
) -> i64 {
    let (before, after) = around(decl.passes.len(), dependencies, pass);
    let mut begun = vec![false; bytes.len()];
    let mut wanted: Vec<bool> = decl.resources.iter().map(|resource| resource.exported.is_some()).collect();
    for &other in live {
        for access in decl.accesses(other) {
            let index = access.resource.index();
            begun[index] |= before[other.index()] || other == pass;
            wanted[index] |= after[other.index()] || other == pass;
        }
    }
    (0..bytes.len()).filter(|&index| begun[index] && wanted[index]).map(|index| bytes[index]).sum()
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
