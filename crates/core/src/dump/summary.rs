//! The plan in one line.

use super::describe::bytes;
use crate::plan::Plan;

impl Plan {
    /// Counts passes, steps, resources and slots, and sums their memory.
    pub fn summary(&self) -> String {
        let assigned = self.slots().map(|slot| slot.resources.len()).sum::<usize>();
        let outside = match self.resources().len() - assigned {
            0 => String::new(),
            others => format!(", {others} external"),
        };
        format!(
            "{} in {}, {} culled; {} in {} of {}{outside}; sharing saves {}",
            count(self.order().len(), "pass", "passes"),
            count(self.steps().len(), "step", "steps"),
            self.culled_count(),
            count(assigned, "resource", "resources"),
            count(self.slots().len(), "slot", "slots"),
            bytes(self.slot_bytes()),
            bytes(self.saved_bytes()),
        )
    }
}

fn count(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}
