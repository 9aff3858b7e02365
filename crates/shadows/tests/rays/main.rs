//! Shadow rays on the CPU, and what is uploaded for the GPU.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod channel;
mod common;
mod edits;
mod levels;
mod lights;
mod origins;
mod scenes;
mod shader;
mod tints;
mod watertight;
