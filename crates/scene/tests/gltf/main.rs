//! Import of glTF files: supported features, errors, and the shared directories of valid and malformed files.
#![cfg(feature = "gltf")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod animations;
mod builder;
mod extensions;
mod features;
mod materials;
mod rejected_values;
mod rejections;
mod shared_files;
mod skins;
