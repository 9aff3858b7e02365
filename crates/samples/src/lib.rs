//! The demo scene and the procedural test scenes, made by code.

pub mod demo;
mod solids;
pub mod trials;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
