//! Checks a frame, and declares the same frame in another order. Like `frames` and `oracle` it uses the crate's
//! public names only.

use super::frames::{PassSpec, Source, Spec};
use super::oracle::{Model, Truth, check_plan};
use crate::Plan;

/// Compiles a frame twice and checks the plan, and returns what is wrong; an invalid frame
/// has no plan.
pub(super) fn check_frame(spec: &Spec) -> Result<Option<Plan>, String> {
    let compile = || {
        let (frame, names) = spec.build();
        (frame.compile().map(|compiled| compiled.into_plan()), names)
    };
    match (compile(), Truth::new(&Model::new(spec)).invalid) {
        ((Ok(plan), names), None) => {
            let breaches = check_plan(spec, &names, &plan);
            if !breaches.is_empty() {
                return Err(format!("{breaches:#?}\n{}\n{spec}", plan.to_text()));
            }
            match compile().0 {
                Ok(again) if again == plan => Ok(Some(plan)),
                _ => Err(format!("compiled twice it differs\n{spec}")),
            }
        }
        ((Err(error), _), Some(invalid)) if error.code() == invalid.code() => Ok(None),
        ((Err(error), _), Some(invalid)) => Err(format!("refused as {error}, not as {invalid:?}\n{spec}")),
        ((Ok(_), _), Some(invalid)) => Err(format!("not refused: {invalid:?}\n{spec}")),
        ((Err(error), _), None) => Err(format!("refused: {error}\n{spec}")),
    }
}

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
