//! One frame put to the test. Like `frames` and `oracle` it uses the crate's public names only.

use super::frames::Spec;
use super::oracle::{Model, Truth, check_plan};
use crate::Plan;

/// Compiles a frame twice and checks the plan, and returns what is wrong; an invalid frame
/// has no plan.
pub(super) fn trial(spec: &Spec) -> Result<Option<Plan>, String> {
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
