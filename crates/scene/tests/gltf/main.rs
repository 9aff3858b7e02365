//! Import of glTF files: what is drawn, what is refused, and the shared folders of good and bad files.
#![cfg(feature = "gltf")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod features;
mod folders;
mod made;
mod materials;
mod refusals;
mod refused_values;
