//! Counts of tests and skips, read from the output and the log of test programs.

use std::collections::{BTreeMap, BTreeSet};

/// Sums over test programs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tally {
    /// Tests that passed, including those that skipped themselves.
    returned: usize,
    /// Tests that failed.
    pub(crate) failed: usize,
    /// Every skip by test, with its reason.
    pub(crate) skips: BTreeMap<String, String>,
    /// The skips of tests that ran and returned early; the others were not run.
    logged: usize,
}

impl Tally {
    /// Reads one line of a test program's output.
    pub(crate) fn read_line(&mut self, line: &str) {
        if let Some(counts) = line.strip_prefix("test result: ") {
            self.returned += count_before(counts, "passed");
            self.failed += count_before(counts, "failed");
        } else if let Some((id, reason)) = ignored_test(line) {
            self.skips.insert(id.to_owned(), reason.to_owned());
        }
    }

    /// Reads the log to which tests append `SKIP <id>: <reason>`.
    pub(crate) fn read_log(&mut self, log: &str) {
        for line in log.lines().filter_map(|line| line.strip_prefix("SKIP ")) {
            let (id, reason) = line.split_once(": ").unwrap_or((line, "no reason given"));
            if self.skips.insert(id.trim().to_owned(), reason.trim().to_owned()).is_none() {
                self.logged += 1;
            }
        }
    }

    /// Returns the number of tests that ran to their end: a skip is not a pass.
    pub(crate) fn passed(&self) -> usize {
        self.returned.saturating_sub(self.logged)
    }

    /// Adds another tally; a skip in both is listed once.
    pub(crate) fn add(&mut self, other: &Tally) {
        self.returned += other.returned;
        self.failed += other.failed;
        self.logged += other.logged;
        self.skips.extend(other.skips.clone());
    }
}

fn count_before(counts: &str, word: &str) -> usize {
    let number = counts.split([';', '.']).find_map(|part| part.trim().strip_suffix(word));
    number.and_then(|number| number.trim().parse().ok()).unwrap_or(0)
}

/// `test NAME ... ignored[, REASON]`
fn ignored_test(line: &str) -> Option<(&str, &str)> {
    let (name, end) = line.strip_prefix("test ")?.rsplit_once(" ... ignored")?;
    match end.strip_prefix(", ") {
        Some(reason) => Some((name, reason)),
        None => end.is_empty().then_some((name, "ignored without a reason")),
    }
}

/// Returns the ids of the allowed skips in the committed list: `<id>` or `<id>: <why>` on each line, `#` for comments.
pub(crate) fn allowed_skips(list: &str) -> BTreeSet<String> {
    let lines = list.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| line.split_once(": ").map_or(line, |(id, _)| id).trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_several_test_programs_add_up() {
        let mut tally = Tally::default();
        tally.read_line(
            "test result: ok. 12 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s",
        );
        tally.read_line("test result: FAILED. 3 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out");
        tally.read_line("a line that says nothing of the kind: 7 passed");
        assert_eq!((tally.passed(), tally.failed), (15, 2));
    }

    #[test]
    fn a_logged_skip_is_not_a_pass() {
        let mut tally = Tally::default();
        tally.read_line("test result: ok. 2 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out");
        tally.read_log("SKIP files: the folder: is absent\nSKIP files: the folder is absent\n");
        assert_eq!(tally.passed(), 1);
        assert_eq!(tally.skips.len(), 1);
    }

    #[test]
    fn ignored_tests_are_skips_that_were_never_counted_as_passed() {
        let mut tally = Tally::default();
        tally.read_line("test gpu::large ... ignored, takes an hour");
        tally.read_line("test src/lib.rs - sketch (line 3) ... ignored");
        tally.read_line("test gpu::small ... ok");
        tally.read_line("test result: ok. 1 passed; 0 failed; 2 ignored; 0 measured; 0 filtered out");
        assert_eq!(tally.passed(), 1);
        assert_eq!(tally.skips["gpu::large"], "takes an hour");
        assert_eq!(tally.skips["src/lib.rs - sketch (line 3)"], "ignored without a reason");
    }

    #[test]
    fn the_list_of_allowed_skips_has_comments_and_reasons() {
        let allowed = allowed_skips("# why\n\nfiles: only where they are\n gpu::large \n");
        assert_eq!(allowed.into_iter().collect::<Vec<_>>(), ["files", "gpu::large"]);
    }
}
