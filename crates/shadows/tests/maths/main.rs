//! The maths of shadows, without a device.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

mod atlas;
mod bias;
mod cascade_plan;
mod cascades;
mod common;
mod documents;
mod filter;
mod layout;
mod numbers;
mod plan;
mod settings;
mod snapping;
mod spot;
