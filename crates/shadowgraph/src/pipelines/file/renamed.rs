//! Former names of ports and outputs, which files may still use.

use super::connect::OUTPUTS;
use super::document::{Connection, Document};
use crate::nodes::port::Port;
use crate::nodes::registry::Nodes;

/// Former names with the current ones.
const RENAMED: &[(&str, &str)] = &[("picture", "image")];

impl Document {
    /// Replaces former names of inputs, of nodes' outputs and of the pipeline's outputs. A kind of node that declares a port with a
    /// former name keeps it.
    pub(super) fn with_current_names(mut self, nodes: &Nodes) -> Self {
        let names = |ports: &[Port]| ports.iter().map(|port| port.name).collect::<Vec<_>>();
        let mut outputs = Vec::new();
        for entry in &mut self.nodes {
            let Some(kind) = nodes.get(&entry.kind.value) else { continue };
            outputs.push((entry.name.value.clone(), names(kind.outputs)));
            rename_keys(&mut entry.inputs, &names(kind.inputs));
        }
        rename_keys(&mut self.outputs, OUTPUTS);
        let connections = self.nodes.iter_mut().flat_map(|entry| &mut entry.inputs).chain(&mut self.outputs);
        for reference in connections.flat_map(|(_, references)| references) {
            if let Some((node, output)) = reference.value.split_once('.')
                && let Some((_, known)) = outputs.iter().find(|(name, _)| name == node)
                && let Some(current) = current_name(output, known)
            {
                reference.value = format!("{node}.{current}");
            }
        }
        self
    }
}

/// Returns the current name for a former one, if only the current one is known.
fn current_name(name: &str, known: &[&str]) -> Option<&'static str> {
    let (_, current) = RENAMED.iter().find(|(former, _)| *former == name)?;
    (known.contains(current) && !known.contains(&name)).then_some(*current)
}

/// Renames the keys of a map, but those whose current name is in it too.
fn rename_keys(connections: &mut [Connection], known: &[&str]) {
    for index in 0..connections.len() {
        let Some(current) = current_name(&connections[index].0.value, known) else { continue };
        if connections.iter().all(|(name, _)| name.value != current) {
            current.clone_into(&mut connections[index].0.value);
        }
    }
}
