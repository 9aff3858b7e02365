//! The summary of a test run: the time of each step, every skip, and one closing line.

use crate::tally::{Tally, allowed_skips};
use std::process::ExitCode;

/// A step that ran.
pub(crate) struct Step {
    pub(crate) name: &'static str,
    pub(crate) seconds: f64,
    pub(crate) error: Option<String>,
    pub(crate) tally: Tally,
}

/// The steps that ran.
#[derive(Default)]
pub(crate) struct Report {
    pub(crate) steps: Vec<Step>,
}

impl Report {
    /// Prints the summary; `list` is the text of the committed list of skips.
    pub(crate) fn finish(&self, list: Result<String, String>) -> ExitCode {
        let (text, succeeded) = self.text(list);
        print!("{text}");
        if succeeded { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }

    fn text(&self, list: Result<String, String>) -> (String, bool) {
        let mut lines = vec!["\n=== summary".to_owned()];
        for step in &self.steps {
            let ran = step.tally.passed() + step.tally.failed;
            let tests = if ran > 0 { format!("   {ran} tests") } else { String::new() };
            let state = if step.error.is_some() { "FAILED" } else { "ok" };
            lines.push(format!("{state:<7} {:>7.1} s  {}{tests}", step.seconds, step.name));
        }
        let mut problems: Vec<String> = self.steps.iter().filter_map(Step::problem).collect();
        let mut total = Tally::default();
        self.steps.iter().for_each(|step| total.add(&step.tally));
        let allowed = list.map(|list| allowed_skips(&list)).unwrap_or_else(|error| {
            problems.push(error);
            Default::default()
        });
        lines.push(format!("{} tests ran, {} skipped", total.passed() + total.failed, total.skips.len()));
        for (id, reason) in &total.skips {
            lines.push(format!("skipped {id}: {reason}"));
            if !allowed.contains(id) {
                problems.push(format!("the skip of {id} is not in tests/skips.txt"));
            }
        }
        lines.extend(problems.iter().map(|problem| format!("FAILED {problem}")));
        let failed = total.failed + self.failures_without_tests();
        lines.push(format!("{} passed, {failed} failed, {} skipped", total.passed(), total.skips.len()));
        (lines.join("\n") + "\n", problems.is_empty())
    }

    /// Counts the steps that failed without a failed test: one failure each.
    fn failures_without_tests(&self) -> usize {
        self.steps.iter().filter(|step| step.error.is_some() && step.tally.failed == 0).count()
    }
}

impl Step {
    fn problem(&self) -> Option<String> {
        self.error.as_ref().map(|error| format!("{}: {error}", self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(name: &'static str, error: Option<&str>, lines: &[&str], log: &str) -> Step {
        let mut tally = Tally::default();
        lines.iter().for_each(|line| tally.read_line(line));
        tally.read_log(log);
        Step { name, seconds: 1.0, error: error.map(str::to_owned), tally }
    }

    fn last(text: &str) -> &str {
        text.lines().last().unwrap_or_default()
    }

    #[test]
    fn a_successful_run_ends_with_its_counts() {
        let ran =
            step("tests", None, &["test result: ok. 5 passed; 0 failed; 0 ignored"], "SKIP a: absent\n");
        let (text, succeeded) = Report { steps: vec![ran] }.text(Ok("a: where it is absent".to_owned()));
        assert!(succeeded);
        assert_eq!(last(&text), "4 passed, 0 failed, 1 skipped");
        assert!(text.contains("skipped a: absent"));
    }

    #[test]
    fn a_skip_that_is_not_in_the_list_fails_the_run() {
        let ran =
            step("tests", None, &["test result: ok. 5 passed; 0 failed; 0 ignored"], "SKIP a: absent\n");
        let (text, succeeded) = Report { steps: vec![ran] }.text(Ok(String::new()));
        assert!(!succeeded);
        assert!(text.contains("FAILED the skip of a is not in tests/skips.txt"), "{text}");
    }

    #[test]
    fn a_failed_step_without_tests_counts_as_one_failure_and_hides_nothing() {
        let lints = step("lints", Some("cargo clippy"), &[], "");
        let ran = step("tests", None, &["test result: ok. 5 passed; 0 failed; 0 ignored"], "");
        let (text, succeeded) = Report { steps: vec![lints, ran] }.text(Ok(String::new()));
        assert!(!succeeded);
        assert_eq!(last(&text), "5 passed, 1 failed, 0 skipped");
    }

    #[test]
    fn a_missing_list_fails_the_run() {
        let (text, succeeded) = Report::default().text(Err("tests/skips.txt: not found".to_owned()));
        assert!(!succeeded && text.contains("FAILED tests/skips.txt: not found"), "{text}");
    }
}
