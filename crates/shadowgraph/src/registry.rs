//! What there is to choose from by name.

use shadowgraph_shadows::Techniques;

use crate::nodes::Nodes;

/// The techniques and kinds of nodes that options and pipeline files can name.
#[derive(Clone)]
pub struct Registry {
    /// Ways of making shadows.
    pub techniques: Techniques,
    /// What pipelines are composed of.
    pub nodes: Nodes,
}

impl Registry {
    /// Returns what Shadowgraph comes with.
    pub fn built_in() -> Self {
        Self { techniques: Techniques::built_in(), nodes: Nodes::built_in() }
    }
}
