//! Nodes that pipelines are composed of, by name.
//!
//! A kind of node is one `impl` of [`Node`]: its name, its inputs, outputs and settings, and the passes that it adds to a frame.
//! [`Nodes`] finds kinds by name, also those of other crates; pipeline files name them.

pub(crate) mod built_in;
pub(crate) mod kind;
pub(crate) mod node;
pub(crate) mod port;
pub(crate) mod ports;
pub(crate) mod registry;
pub(crate) mod setting;

pub use built_in::geometry::Geometry as GeometryNode;
pub use kind::NodeKind;
pub use node::Node;
pub use port::{Port, PortKind, Presence, Value};
pub use ports::Ports;
pub use registry::Nodes;
pub use setting::{Setting, SettingType, Settings};

#[cfg(test)]
mod tests;
