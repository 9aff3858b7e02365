//! The same frame declared in another order.

use super::frames::{PassSpec, Source, Spec};
use super::oracle::Model;

/// Declares passes in another order that keeps every hazard, so that the frame has the same meaning.
pub(super) fn shuffled(spec: &Spec, source: &mut Source<'_>) -> Spec {
    let model = Model::new(spec);
    let mut left: Vec<usize> = (0..spec.passes.len()).collect();
    let mut order = Vec::new();
    while !left.is_empty() {
        let first = |&pass: &usize| left.iter().all(|&other| other >= pass || !model.ordered(other, pass));
        let ready: Vec<usize> = left.iter().copied().filter(first).collect();
        let next = source.pick(&ready);
        order.push(next);
        left.retain(|&pass| pass != next);
    }
    let position = |pass: &usize| order.iter().position(|other| other == pass).unwrap();
    let moved = |&pass: &usize| {
        let own = &spec.passes[pass];
        PassSpec { after: own.after.iter().map(position).collect(), ..own.clone() }
    };
    Spec { passes: order.iter().map(moved).collect(), ..spec.clone() }
}
