//! Shadow rays on the CPU, and their buffers for the GPU.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

mod channel;
mod common;
mod flat;
mod lights;
mod origins;
mod scenes;
mod shader;
mod tints;
mod watertight;
