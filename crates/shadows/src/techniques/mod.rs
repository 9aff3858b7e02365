//! The techniques that come with Shadowgraph, a room each.

mod layout;
mod none;
mod pcf;
mod raytraced;

pub use none::NoShadows;
pub use pcf::Pcf;
pub use raytraced::{MAX_MASK_LAYERS, Raytraced};
