//! The demo scene and the procedural test scenes, created in code.

pub mod demo;
mod insert;
mod mesh_builder;
mod round;
pub mod test_scenes;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
