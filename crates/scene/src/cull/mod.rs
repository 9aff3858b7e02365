//! Culling: which boxes touch what a camera or a shadow tile can see.
//!
//! A [`CullVolume`] tells it of one box, a [`CullTree`] of many at once. The two agree bit for bit: a query of the
//! tree finds what testing each box would find, no more and no less.

mod ascending;
mod node;
mod part;
mod parts;
#[cfg(test)]
mod samples;
mod tree;
mod visible;
mod volume;

pub use tree::CullTree;
pub use visible::visible_instances;
pub use volume::{BoundingSphere, Cone, CullVolume};
