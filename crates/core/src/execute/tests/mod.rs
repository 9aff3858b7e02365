//! Recording frames: on wgpu's noop device, which validates everything and draws nothing, and if there is a driver also on
//! a device that draws.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod capture;
mod copies;
mod depth;
mod errors;
mod frames;
mod gpu;
mod history;
mod imports;
mod lost;
mod merged;
mod parts;
mod poison;
mod resolve;
mod reuse;
mod threads;
mod times;
mod truth;
mod values;
mod visit;
mod watch;

use gpu::{Compute, Draw};
