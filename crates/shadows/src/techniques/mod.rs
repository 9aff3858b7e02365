//! The techniques that come with Shadowgraph, a room each.

mod layout;
mod mask;
mod none;
mod pcf;
mod pcss;
mod raytraced;
mod screen;
mod variant;

pub use mask::MAX_MASK_LAYERS;
pub use none::NoShadows;
pub use pcf::Pcf;
pub use pcss::Pcss;
pub use raytraced::Raytraced;
pub use screen::ScreenShadows;
pub use variant::PcfVariant;
