//! What stands in a file and serves nothing.

use super::choose::parameter_of;
use super::document::{Condition, Document, Entry, Feed};
use super::resolve::Resolved;
use super::source::{PipelineError, Spot};
use crate::nodes::Nodes;

impl Document {
    /// Tells of nodes, of those that are there, which lead to no output, and of parameters that nothing asks for, whatever is chosen.
    pub(super) fn unused(&self, nodes: &Nodes, there: &Resolved) -> Vec<PipelineError> {
        let here = |entry: &Entry| there.nodes.iter().any(|node| node.name == entry.name.value);
        let idle = self.idle_nodes(nodes).filter(|entry| here(entry));
        let node = |Entry { name, kind, .. }: &Entry| {
            name.error(format!(
                "`{}` ({}) leads to no output: name it in the inputs of a node that does, or take it out",
                name.value, kind.value
            ))
        };
        let parameter = |name: &Spot<String>| {
            let own = &name.value;
            name.error(format!(
                "nothing asks for the parameter `{own}`: a setting does by \"${own}\", or a node by `when`"
            ))
        };
        idle.map(node).chain(self.idle_parameters().map(parameter)).collect()
    }

    fn idle_nodes(&self, nodes: &Nodes) -> impl Iterator<Item = &Entry> {
        // A kind without outputs is there for what it does.
        let gives = |entry: &Entry| nodes.get(&entry.kind.value).is_none_or(|kind| !kind.outputs.is_empty());
        let mut serves: Vec<bool> = self.nodes.iter().map(|entry| !gives(entry)).collect();
        let mut feeds: Vec<&Feed> = self.outputs.iter().collect();
        feeds.extend(self.nodes.iter().filter(|entry| !gives(entry)).flat_map(|entry| &entry.inputs));
        while let Some((_, from)) = feeds.pop() {
            for reference in from {
                let node = reference.value.split('.').next().unwrap_or_default();
                if let Some(at) = self.nodes.iter().position(|entry| entry.name.value == node)
                    && !std::mem::replace(&mut serves[at], true)
                {
                    feeds.extend(&self.nodes[at].inputs);
                }
            }
        }
        self.nodes.iter().zip(serves).filter(|(_, serves)| !serves).map(|(entry, _)| entry)
    }

    fn idle_parameters(&self) -> impl Iterator<Item = &Spot<String>> {
        let settings = self.nodes.iter().flat_map(|entry| &entry.settings);
        let mut asked: Vec<&str> = settings.filter_map(|(_, value)| parameter_of(&value.value)).collect();
        self.nodes.iter().filter_map(|entry| entry.when.as_ref()).for_each(|when| when.value.ask(&mut asked));
        self.parameters.iter().map(|(name, _)| name).filter(move |name| !asked.contains(&name.value.as_str()))
    }
}

impl Condition {
    /// Adds the parameters that it looks at.
    fn ask<'c>(&'c self, asked: &mut Vec<&'c str>) {
        match self {
            Self::On(name) | Self::Is(name, _) => asked.push(name),
            Self::Not(inner) => inner.ask(asked),
            Self::All(list) | Self::Any(list) => list.iter().for_each(|inner| inner.ask(asked)),
        }
    }
}
