//! Culling: which boxes intersect what a camera or a shadow tile can see.
//!
//! A [`CullVolume`] tests one box, a [`CullTree`] many at once. The two agree to the bit: a query of the tree finds
//! exactly the boxes that a test of each would find.

mod node;
#[cfg(test)]
mod samples;
mod shapes;
mod sort;
mod tree;
mod volume;

pub use shapes::{BoundingSphere, Cone};
pub use tree::CullTree;
pub use volume::CullVolume;
