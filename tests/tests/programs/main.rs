//! Tests that start built programs: `shadowgraph`, the examples, a browser. One test program, so that cargo builds them once.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod bad_gltf;
mod browser;
mod check_values;
mod drivers;
mod dump;
mod examples;
mod first_image;
mod fly;
mod hashes;
mod live_page;
mod measure;
mod nodes;
mod pages;
mod pixel;
mod recordings;
#[cfg(target_os = "linux")]
mod view;
mod web;
