#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod bands;
mod detached;
mod edges;
mod faults;
mod masks;
mod points;
mod refused;
mod test_image;
