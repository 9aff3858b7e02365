//! The techniques that come with Shadowgraph, a room each.

mod pcf;

pub use pcf::Pcf;
