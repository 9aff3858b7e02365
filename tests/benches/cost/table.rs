//! The table of measured costs and their targets.

use std::fmt::Write as _;

/// A table with headings.
#[derive(Default)]
pub(crate) struct Table {
    text: String,
    missed: u32,
}

/// The maximum of a figure.
#[derive(Clone, Copy)]
pub(crate) enum Target {
    /// Maximum in microseconds.
    Micros(f64),
    /// Maximum as a multiple of the reference.
    Times(f64),
    /// No maximum; only for comparison.
    None,
}

impl Table {
    pub(crate) fn heading(&mut self, heading: &str) {
        _ = writeln!(self.text, "\n{heading:<58}{:>13}{:>10}{:>12}", "measured", "ratio", "target");
    }

    /// Adds a figure in seconds, with its ratio to the reference if there is one.
    pub(crate) fn row(&mut self, figure: &str, seconds: f64, ratio: Option<f64>, target: Target) {
        let micros = seconds * 1e6;
        let (target, missed) = match target {
            Target::Micros(most) => (format!("{most} us"), micros > most),
            Target::Times(most) => (format!("{most} x"), ratio.is_some_and(|ratio| ratio > most)),
            Target::None => (String::new(), false),
        };
        let ratio = ratio.map(|ratio| format!("{ratio:.2} x")).unwrap_or_default();
        let mark = if missed { "  MISSED" } else { "" };
        self.missed += u32::from(missed);
        _ = writeln!(self.text, "  {figure:<56}{micros:>10.3} us{ratio:>10}{target:>12}{mark}");
    }

    pub(crate) fn print(&self) {
        println!("{}\n{} targets missed", self.text, self.missed);
        println!("Tests compare figures that are counted with their targets:");
        println!("  allocations: crates/core/tests/allocations.rs");
        println!("  slots, and the peak of the chosen order: crates/core/src/compile/tests/memory.rs");
    }
}
