//! The techniques that come with Shadowgraph, a room each.

mod layout;
mod none;
mod pcf;
mod raytraced;
mod variant;

pub use none::NoShadows;
pub use pcf::Pcf;
pub use raytraced::{MAX_MASK_LAYERS, Raytraced};
pub use variant::PcfVariant;
