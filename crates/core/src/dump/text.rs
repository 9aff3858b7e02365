//! The plan as aligned text, at most 110 columns wide.

mod passes;
mod resources;

use super::describe::clip;
use crate::declaration::{Options, OrderPolicy};
use crate::plan::Plan;
use std::fmt::Write as _;

/// Maximum length of a line; longer text is cut with an ellipsis.
const COLUMNS: usize = 110;

impl Plan {
    /// Returns the plan as text: passes by node and in order, with their accesses, loads and stores; culled passes;
    /// and resources by the slot, a physical texture or buffer, that they share. Every decision has its reason. The
    /// same plan gives the same text.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        self.write_summary(&mut out);
        self.write_passes(&mut out);
        self.write_culled(&mut out);
        self.write_resources(&mut out);
        fit(&out)
    }

    fn write_summary(&self, out: &mut String) {
        let _ = writeln!(out, "plan: {}", self.summary());
        let options = options(self.options());
        if !options.is_empty() {
            let _ = writeln!(out, "options: {}", options.join(", "));
        }
    }

    fn write_culled(&self, out: &mut String) {
        if self.culled_count() == 0 {
            return;
        }
        out.push_str("\nculled\n");
        for (id, pass) in self.passes() {
            if let Some(reason) = pass.culled {
                let path = clip(&self.pass_path(id), 40);
                let _ = writeln!(out, "  {path:<40}  {}", self.describe_cull(reason));
            }
        }
    }
}

/// Names the options that differ from the default.
fn options(options: Options) -> Vec<&'static str> {
    let Options { order, merge, transient_attachments } = options;
    let order = match order {
        OrderPolicy::Automatic => None,
        OrderPolicy::Memory => Some("the order is chosen by memory only, not for merging"),
        OrderPolicy::Declared => Some("the order of declaration is fixed"),
    };
    let merge = (!merge).then_some("merging is off");
    let transient = (!transient_attachments).then_some("transient attachments are off");
    [order, merge, transient].into_iter().flatten().collect()
}

/// Cuts every line to the width and its trailing blanks.
fn fit(text: &str) -> String {
    text.lines().flat_map(|line| [clip(line.trim_end(), COLUMNS), "\n".into()]).collect()
}
