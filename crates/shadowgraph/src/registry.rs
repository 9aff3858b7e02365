//! Techniques and nodes by name.

use shadowgraph_shadows::Techniques;

use crate::nodes::registry::Nodes;

/// The techniques and the kinds of nodes that options and pipeline files can name.
#[derive(Clone)]
pub struct Registry {
    /// Shadow techniques.
    pub techniques: Techniques,
    /// Kinds of nodes.
    pub nodes: Nodes,
}

impl Registry {
    /// Returns the built-in techniques and nodes.
    pub fn built_in() -> Self {
        Self { techniques: Techniques::built_in(), nodes: Nodes::built_in() }
    }
}
