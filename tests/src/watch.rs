//! A program under a limit of time and memory.

use std::io::{self, Read};
use std::process::{Child, Command, Stdio};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

const POLL: Duration = Duration::from_millis(4);

/// What a program may use.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Time from start to end.
    pub time: Duration,
    /// Resident memory at its highest, bytes. Watched on Linux only.
    pub memory_bytes: u64,
}

/// How a program ended.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The exit code; `None` when a signal ended it.
    pub code: Option<i32>,
    /// What it wrote to standard output.
    pub stdout: String,
    /// What it wrote to standard error.
    pub stderr: String,
    /// How long it ran.
    pub time: Duration,
    /// The highest resident memory that was seen, bytes; 0 where it cannot be watched.
    pub peak_bytes: u64,
    /// The limit for which it was stopped.
    pub stopped: Option<&'static str>,
}

/// Runs a program to its end, or stops it at the first limit that it goes over.
///
/// # Errors
/// When it cannot be started or waited for.
pub fn run(command: &mut Command, limits: Limits) -> io::Result<Outcome> {
    let start = Instant::now();
    let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    let stdout = child.stdout.take().map(collect);
    let stderr = child.stderr.take().map(collect);
    let (mut peak_bytes, mut stopped) = (0, None);
    let status = loop {
        peak_bytes = peak_bytes.max(peak_of(&child));
        if let Some(status) = child.try_wait()? {
            break status;
        }
        stopped = stopped.or(over(limits, start.elapsed(), peak_bytes));
        if stopped.is_some() {
            child.kill()?;
        }
        sleep(POLL);
    };
    Ok(Outcome {
        code: status.code(),
        stdout: text(stdout),
        stderr: text(stderr),
        time: start.elapsed(),
        peak_bytes,
        stopped,
    })
}

fn over(limits: Limits, time: Duration, peak_bytes: u64) -> Option<&'static str> {
    if time > limits.time {
        Some("it ran longer than the limit")
    } else if peak_bytes > limits.memory_bytes {
        Some("it used more memory than the limit")
    } else {
        None
    }
}

/// The kernel's own record of the highest resident size, so that nothing is missed between two looks.
fn peak_of(child: &Child) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches("kB").trim().parse::<u64>().ok());
    kib.unwrap_or(0) * 1024
}

/// Reads all output in a thread, so that a full pipe does not block the program.
fn collect(mut pipe: impl Read + Send + 'static) -> JoinHandle<Vec<u8>> {
    spawn(move || {
        let mut bytes = Vec::new();
        // A pipe that breaks has given what there was.
        let _broken = pipe.read_to_end(&mut bytes);
        bytes
    })
}

fn text(reader: Option<JoinHandle<Vec<u8>>>) -> String {
    let bytes = reader.and_then(|reader| reader.join().ok()).unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    const LIMITS: Limits = Limits { time: Duration::from_secs(20), memory_bytes: 64 << 20 };

    fn shell(script: &str, limits: Limits) -> Outcome {
        run(Command::new("sh").args(["-c", script]), limits).unwrap()
    }

    #[test]
    fn code_and_output_are_those_of_the_program() {
        let outcome = shell("echo out; echo err >&2; exit 3", LIMITS);
        assert_eq!((outcome.code, outcome.stopped), (Some(3), None));
        assert_eq!((outcome.stdout.as_str(), outcome.stderr.as_str()), ("out\n", "err\n"));
    }

    #[test]
    fn a_program_that_hangs_is_stopped() {
        let outcome = shell("exec sleep 60", Limits { time: Duration::from_millis(100), ..LIMITS });
        assert_eq!(outcome.stopped, Some("it ran longer than the limit"));
        assert!(outcome.time < Duration::from_secs(10));
    }

    #[test]
    fn a_program_that_eats_memory_is_stopped() {
        // Doubles a shell variable until the limit is met.
        let outcome = shell("x=0123456789abcdef; while :; do x=$x$x; done", LIMITS);
        assert_eq!(outcome.stopped, Some("it used more memory than the limit"));
        assert!(outcome.peak_bytes > LIMITS.memory_bytes);
    }
}
