//! The techniques that come with Shadowgraph, a room each.

mod none;
mod pcf;

pub use none::NoShadows;
pub use pcf::Pcf;
