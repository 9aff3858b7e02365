//! Warnings about nodes and parameters without effect.

use super::document::{Condition, Connection, Document, NodeEntry};
use super::parameters::referenced_parameter;
use super::resolve::ResolvedPipeline;
use super::source::Spanned;
use crate::error::PipelineError;
use crate::nodes::registry::Nodes;

impl Document {
    /// Returns warnings about enabled nodes that no output depends on, and about parameters that are never used.
    pub(super) fn unused(&self, nodes: &Nodes, resolved: &ResolvedPipeline) -> Vec<PipelineError> {
        let is_enabled = |entry: &&NodeEntry| resolved.nodes.iter().any(|node| node.name == entry.name.value);
        let node = |NodeEntry { name, kind, .. }: &NodeEntry| {
            name.error(format!(
                "no output depends on `{}` ({}): connect it to a node that an output depends on, or remove it",
                name.value, kind.value
            ))
        };
        let parameter = |name: &Spanned<String>| {
            let own = &name.value;
            name.error(format!(
                "unused parameter `{own}`: use it as \"${own}\" in a setting, or in a node's `when`"
            ))
        };
        let unused_nodes = self.unused_nodes(nodes).filter(is_enabled);
        unused_nodes.map(node).chain(self.unused_parameters().map(parameter)).collect()
    }

    fn unused_nodes(&self, nodes: &Nodes) -> impl Iterator<Item = &NodeEntry> {
        // A kind without outputs is used for its side effects.
        let has_outputs =
            |entry: &NodeEntry| nodes.get(&entry.kind.value).is_none_or(|kind| !kind.outputs.is_empty());
        let mut used: Vec<bool> = self.nodes.iter().map(|entry| !has_outputs(entry)).collect();
        let mut connections: Vec<&Connection> = self.outputs.iter().collect();
        connections
            .extend(self.nodes.iter().filter(|entry| !has_outputs(entry)).flat_map(|entry| &entry.inputs));
        while let Some((_, outputs)) = connections.pop() {
            for output in outputs {
                let node = output.value.split('.').next().unwrap_or_default();
                if let Some(index) = self.nodes.iter().position(|entry| entry.name.value == node)
                    && !std::mem::replace(&mut used[index], true)
                {
                    connections.extend(&self.nodes[index].inputs);
                }
            }
        }
        self.nodes.iter().zip(used).filter(|(_, used)| !used).map(|(entry, _)| entry)
    }

    fn unused_parameters(&self) -> impl Iterator<Item = &Spanned<String>> {
        let settings = self.nodes.iter().flat_map(|entry| &entry.settings);
        let in_settings = settings.filter_map(|(_, value)| referenced_parameter(&value.value));
        let conditions = self.nodes.iter().filter_map(|entry| entry.when.as_ref());
        let used: Vec<&str> = in_settings.chain(conditions.map(|when| when.value.parameter())).collect();
        self.parameters.iter().map(|(name, _)| name).filter(move |name| !used.contains(&name.value.as_str()))
    }
}

impl Condition {
    /// Returns the parameter that it depends on.
    fn parameter(&self) -> &str {
        match self {
            Self::On(name) => name,
            Self::Not(inner) => inner.parameter(),
        }
    }
}
