//! Progress on a terminal, for loading and for everything that takes longer than a second.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

const PARTS: u64 = 100;
const WITHOUT_BAR: &str = "{spinner} {msg} {elapsed}";
const WITH_BAR: &str = "{spinner} {msg} {wide_bar} {pos} %";
const TICK: Duration = Duration::from_millis(100);

/// A progress line on standard error, removed on drop.
///
/// If standard error is not a terminal, nothing is shown.
pub(crate) struct Progress {
    bar: ProgressBar,
    what: String,
    /// Dropping the sender stops the thread.
    waiting: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    /// Shows `what` immediately.
    pub(crate) fn now(what: &str) -> Progress {
        Self::after(Duration::ZERO, what)
    }

    /// Shows `what` after one second.
    pub(crate) fn if_slow(what: &str) -> Progress {
        Self::after(Duration::from_secs(1), what)
    }

    /// Sets the current stage and the finished fraction, 0 to 1.
    pub(crate) fn set(&self, stage: &str, fraction: f32) {
        if self.bar.length().is_none() {
            self.bar.set_length(PARTS);
            self.bar.set_style(style(WITH_BAR));
        }
        self.bar.set_message(format!("{}: {stage}", self.what));
        self.bar.set_position((fraction.clamp(0.0, 1.0) * PARTS as f32) as u64);
    }

    fn after(delay: Duration, what: &str) -> Progress {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        bar.set_style(style(WITHOUT_BAR));
        bar.set_message(what.to_owned());
        let waiting = std::io::stderr().is_terminal().then(|| Self::show(bar.clone(), delay));
        Progress { bar, what: what.to_owned(), waiting }
    }

    fn show(bar: ProgressBar, delay: Duration) -> (Sender<()>, JoinHandle<()>) {
        let (stop, stopped) = channel();
        let thread = std::thread::spawn(move || {
            if stopped.recv_timeout(delay) != Err(RecvTimeoutError::Timeout) {
                return;
            }
            bar.set_draw_target(ProgressDrawTarget::stderr());
            while stopped.recv_timeout(TICK) == Err(RecvTimeoutError::Timeout) {
                bar.tick();
            }
        });
        (stop, thread)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((stop, thread)) = self.waiting.take() {
            drop(stop);
            // A thread that only draws has nothing to report.
            let _joined = thread.join();
        }
        self.bar.finish_and_clear();
    }
}

fn style(template: &str) -> ProgressStyle {
    ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_spinner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Instant;

    #[test]
    fn progress_that_is_never_shown_costs_no_time() {
        let start = Instant::now();
        let progress = Progress::if_slow("waiting");
        progress.set("half", 0.5);
        drop(progress);
        assert!(start.elapsed() < Duration::from_millis(900));
    }

    #[test]
    fn both_templates_are_valid() {
        assert!(ProgressStyle::with_template(WITHOUT_BAR).is_ok());
        assert!(ProgressStyle::with_template(WITH_BAR).is_ok());
    }
}
