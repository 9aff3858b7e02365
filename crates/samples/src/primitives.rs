//! Procedural meshes: boxes, round primitives and surface patches.

pub(crate) mod mesh_builder;
pub(crate) mod round;
