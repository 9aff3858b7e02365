//! Explanations of a pass, a resource or an order, in sentences.

mod name;
mod order;
mod pass;
mod resource;

pub use name::{explain, explain_order};
pub use order::explain_why_before;
pub use pass::explain_pass;
pub use resource::explain_resource;
pub(crate) use resource::{describe_origin, usages};

use std::fmt::Write as _;

/// Sentences below a heading, one for each line.
struct Page(String);

impl Page {
    fn new(heading: &str) -> Self {
        Self(format!("{heading}\n"))
    }

    fn line(&mut self, depth: usize, text: &str) {
        if !text.is_empty() {
            let _ = writeln!(self.0, "{:width$}{text}", "", width = 2 * depth);
        }
    }
}
