//! Resolves a document to nodes in order, with the indices of the values at their ports.

use shadowgraph_core::did_you_mean;

use super::connect::Connections;
use super::document::{Document, NodeEntry};
use super::enabled::{ConnectedInput, EnabledNode, OutputRef};
use super::order::{in_place_nodes, order};
use super::parameters::{ParameterValues, referenced_parameter};
use crate::error::PipelineError;
use crate::nodes::kind::NodeKind;
use crate::nodes::port::Port;
use crate::nodes::registry::Nodes;
use crate::nodes::setting::Settings;

/// An enabled node, with the indices of the values at its ports.
pub(super) struct ResolvedNode {
    pub(super) name: String,
    pub(super) kind: NodeKind,
    pub(super) settings: Settings,
    pub(super) inputs: Vec<(Port, Option<usize>)>,
    pub(super) outputs: Vec<(Port, usize)>,
}

/// The nodes in order, and the values that are the pipeline's outputs.
pub(super) struct ResolvedPipeline {
    pub(super) nodes: Vec<ResolvedNode>,
    /// The node and the output that the view's image comes from.
    pub(super) image_output: (usize, &'static str),
    /// Indices of values.
    pub(super) image: usize,
    pub(super) light: Option<usize>,
    pub(super) depth: Option<usize>,
    /// Of each value, whether a node or an output of the pipeline reads it.
    pub(super) is_read: Vec<bool>,
}

impl Document {
    /// Connects and orders the enabled nodes.
    pub(super) fn resolve(
        &self,
        name: &str,
        nodes: &Nodes,
        parameters: &ParameterValues<'_>,
    ) -> Result<ResolvedPipeline, PipelineError> {
        self.check_kinds(nodes)?;
        let (enabled, value_count) = self.enabled_nodes(nodes, parameters);
        let connections = Connections { document: self, nodes: &enabled };
        let inputs = enabled.iter().map(|node| connections.inputs(node)).collect::<Result<Vec<_>, _>>()?;
        let in_place = in_place_nodes(&enabled, &inputs)?;
        let order = order(&enabled, &inputs, &in_place)?;
        let outputs = connections.outputs(name, &in_place)?;
        let find = |wanted: &str| outputs.iter().find(|(name, _)| *name == wanted).map(|(_, output)| *output);
        let Some(image) = find("image") else {
            let problem = "missing output `image`: name the output of a node that is the finished image";
            return Err(PipelineError { location: name.into(), problem: problem.into() });
        };
        let value = |OutputRef { node, port }: OutputRef| enabled[node].first_value + port;
        let mut is_read = vec![false; value_count];
        let by_nodes = inputs.iter().flatten().filter_map(|input| input.value);
        for read in by_nodes.chain(outputs.iter().map(|(_, output)| value(*output))) {
            is_read[read] = true;
        }
        let resolved = order.iter().map(|&index| resolve_node(&enabled[index], &inputs[index], parameters));
        Ok(ResolvedPipeline {
            nodes: resolved.collect::<Result<_, _>>()?,
            image_output: (
                order.iter().position(|&index| index == image.node).unwrap_or_default(),
                enabled[image.node].kind.outputs[image.port].name,
            ),
            image: value(image),
            light: find("light").map(value),
            depth: find("depth").map(value),
            is_read,
        })
    }

    /// Returns the nodes whose `when` holds, and how many values their outputs have.
    fn enabled_nodes(
        &self,
        nodes: &Nodes,
        parameters: &ParameterValues<'_>,
    ) -> (Vec<EnabledNode<'_>>, usize) {
        let (mut enabled, mut first_value) = (Vec::new(), 0);
        for entry in &self.nodes {
            let holds = entry.when.as_ref().is_none_or(|when| parameters.holds(&when.value));
            if let Some(kind) = nodes.get(&entry.kind.value).filter(|_| holds) {
                enabled.push(EnabledNode { entry, kind: *kind, first_value });
                first_value += kind.outputs.len();
            }
        }
        (enabled, first_value)
    }

    /// Checks the names of nodes, kinds, inputs and settings.
    fn check_kinds(&self, nodes: &Nodes) -> Result<(), PipelineError> {
        for (index, entry) in self.nodes.iter().enumerate() {
            let name = &entry.name;
            if name.value.is_empty() || name.value.contains(['.', '/', '$']) {
                let problem = format!("invalid node name `{}`: expected a name without . / $", name.value);
                return Err(name.error(problem));
            }
            if let Some(other) = self.nodes[..index].iter().find(|other| other.name.value == name.value) {
                let first = other.name.location.describe();
                return Err(
                    name.error(format!("duplicate node name `{}`; the first is at {first}", name.value))
                );
            }
            let Some(kind) = nodes.get(&entry.kind.value) else {
                let hint = did_you_mean(&entry.kind.value, nodes.kinds().iter().map(|kind| kind.name));
                return Err(entry.kind.error(format!("unknown node kind `{}`{hint}", entry.kind.value)));
            };
            let node = format!("`{}` ({})", name.value, kind.name);
            for (input, _) in &entry.inputs {
                if !kind.inputs.iter().any(|port| port.name == input.value) {
                    let hint = did_you_mean(&input.value, kind.inputs.iter().map(|port| port.name));
                    return Err(input.error(format!("unknown input `{}` of {node}{hint}", input.value)));
                }
            }
            for (setting, _) in &entry.settings {
                if !kind.settings.iter().any(|known| known.name == setting.value) {
                    let hint = did_you_mean(&setting.value, kind.settings.iter().map(|known| known.name));
                    return Err(setting.error(format!("unknown setting `{}` of {node}{hint}", setting.value)));
                }
            }
        }
        Ok(())
    }
}

fn resolve_node(
    node: &EnabledNode<'_>,
    inputs: &[ConnectedInput],
    parameters: &ParameterValues<'_>,
) -> Result<ResolvedNode, PipelineError> {
    let EnabledNode { entry, kind, first_value } = node;
    Ok(ResolvedNode {
        name: entry.name.value.clone(),
        kind: *kind,
        settings: settings(entry, kind, parameters)?,
        inputs: inputs.iter().map(|input| (input.port, input.value)).collect(),
        outputs: kind.outputs.iter().enumerate().map(|(index, port)| (*port, first_value + index)).collect(),
    })
}

fn settings(
    entry: &NodeEntry,
    kind: &NodeKind,
    parameters: &ParameterValues<'_>,
) -> Result<Settings, PipelineError> {
    let mut values = Vec::new();
    for setting in kind.settings {
        let given = entry.settings.iter().find(|(name, _)| name.value == setting.name);
        let value = given
            .map_or_else(|| setting.default_value(), |(_, value)| parameters.resolve(&value.value).clone());
        if let (Err(error), Some((_, given))) = (setting.check(&value), given) {
            let parameter = referenced_parameter(&given.value);
            let parameter = parameter.map(|name| format!(", set by the parameter `{name}`"));
            let problem = format!("`{}`: {error}{}", entry.name.value, parameter.unwrap_or_default());
            return Err(given.error(problem));
        }
        values.push((setting, value));
    }
    Ok(Settings::new(kind.name, values))
}
