//! Runs programs under limits of time and memory.

use std::io::{self, Read};
use std::process::{Child, Command, Stdio};
use std::thread::{JoinHandle, sleep, spawn};
use std::time::{Duration, Instant};

const POLL: Duration = Duration::from_millis(4);

/// Limits of a program's run.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// The longest time from start to end.
    pub time: Duration,
    /// The largest resident memory, bytes. Only checked on Linux.
    pub memory_bytes: u64,
}

/// Outcome of a program.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The exit code; `None` when a signal ended it.
    pub code: Option<i32>,
    /// The text on standard output.
    pub stdout: String,
    /// The text on standard error.
    pub stderr: String,
    /// The time that it ran.
    pub time: Duration,
    /// The peak of resident memory, bytes; 0 where it cannot be read.
    pub peak_bytes: u64,
    /// The limit that stopped it.
    pub stopped: Option<&'static str>,
}

/// Runs a program to its end, or stops it at the first limit that it exceeds.
///
/// # Errors
/// If it cannot be started or waited for.
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
        stopped = stopped.or(exceeded(limits, start.elapsed(), peak_bytes));
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

fn exceeded(limits: Limits, time: Duration, peak_bytes: u64) -> Option<&'static str> {
    if time > limits.time {
        Some("it ran longer than the limit")
    } else if peak_bytes > limits.memory_bytes {
        Some("it used more memory than the limit")
    } else {
        None
    }
}

/// Reads the peak of resident memory that the kernel keeps, so that no peak between two polls is missed.
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
        // A broken pipe has already delivered its data.
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
