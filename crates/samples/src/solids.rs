//! Meshes made by code: boxes, round things, and patches of surfaces.

pub(crate) mod round;
pub(crate) mod shape;
