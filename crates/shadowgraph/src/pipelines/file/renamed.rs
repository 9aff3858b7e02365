//! Former names of ports, outputs and settings, which files may still use.

use super::connect::OUTPUTS;
use super::document::Document;
use super::source::Spanned;
use crate::nodes::port::Port;
use crate::nodes::registry::Nodes;

/// Former names with the current ones.
const RENAMED: &[(&str, &str)] =
    &[("picture", "image"), ("collected", "screen_space"), ("fresh", "current_weight")];

impl Document {
    /// Replaces former names of inputs, settings, nodes' outputs and the pipeline's outputs. Kinds of nodes that declare a former
    /// name themselves keep it.
    pub(super) fn with_current_names(mut self, nodes: &Nodes) -> Self {
        let names = |ports: &[Port]| ports.iter().map(|port| port.name).collect::<Vec<_>>();
        let mut outputs = Vec::new();
        for entry in &mut self.nodes {
            let Some(kind) = nodes.get(&entry.kind.value) else { continue };
            outputs.push((entry.name.value.clone(), names(kind.outputs)));
            rename_keys(&mut entry.inputs, &names(kind.inputs));
            let settings: Vec<&str> = kind.settings.iter().map(|setting| setting.name).collect();
            rename_keys(&mut entry.settings, &settings);
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
fn rename_keys<T>(entries: &mut [(Spanned<String>, T)], known: &[&str]) {
    for index in 0..entries.len() {
        let Some(current) = current_name(&entries[index].0.value, known) else { continue };
        if entries.iter().all(|(name, _)| name.value != current) {
            current.clone_into(&mut entries[index].0.value);
        }
    }
}
