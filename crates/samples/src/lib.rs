//! The demo scene, the procedural test scenes and a procedural city, created in code.

pub mod city;
pub mod demo;
mod insert;
mod mesh_builder;
mod named;
mod round;
pub mod test_scenes;

pub use named::{UnknownScene, named_scene};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
