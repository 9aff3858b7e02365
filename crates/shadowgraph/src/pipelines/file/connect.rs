//! Connections: names of outputs become nodes and values.

use shadowgraph_core::did_you_mean;

use super::document::{Connection, Document};
use super::enabled::{ConnectedInput, EnabledNode, OutputRef};
use super::order::InPlaceNodes;
use super::source::{Location, Spanned};
use crate::error::PipelineError;
use crate::nodes::port::{Port, PortKind, Presence};

/// The outputs of a pipeline.
pub(super) const OUTPUTS: &[&str] = &["image", "light", "depth"];

/// The enabled nodes of a document, to look outputs up in.
pub(super) struct Connections<'c, 'd> {
    pub(super) document: &'d Document,
    pub(super) nodes: &'c [EnabledNode<'d>],
}

impl Connections<'_, '_> {
    /// Connects the inputs of a node.
    pub(super) fn inputs(&self, node: &EnabledNode<'_>) -> Result<Vec<ConnectedInput>, PipelineError> {
        node.kind.inputs.iter().map(|port| self.input(node, port)).collect()
    }

    fn input(&self, node: &EnabledNode<'_>, port: &Port) -> Result<ConnectedInput, PipelineError> {
        let connection = node.entry.inputs.iter().find(|(name, _)| name.value == port.name);
        let output = connection.map(|connection| self.find(port.name, connection)).transpose()?.flatten();
        let Some(output) = output else {
            if port.presence == Presence::Required {
                return Err(self.unconnected(node, port, connection));
            }
            return Ok(ConnectedInput { port: *port, value: None, producer: None });
        };
        let location = connection.map_or(&node.entry.name.location, |(name, _)| &name.location);
        self.check_types(location, node, port, output)?;
        let value = self.nodes[output.node].first_value + output.port;
        Ok(ConnectedInput { port: *port, value: Some(value), producer: Some(output.node) })
    }

    /// Checks that an output has the kind and the format of an input.
    fn check_types(
        &self,
        location: &Location,
        node: &EnabledNode<'_>,
        port: &Port,
        output: OutputRef,
    ) -> Result<(), PipelineError> {
        let produced = self.nodes[output.node].kind.outputs[output.port];
        let (input, node) = (port.name, &node.entry.name.value);
        let output = self.output_name(output);
        if produced.kind != port.kind {
            let (expected, found) = (port.kind.name(), produced.kind.name());
            let problem = format!("`{input}` of `{node}` expects a {expected}, and `{output}` is a {found}");
            return Err(location.error(problem));
        }
        match (port.format, produced.format) {
            (Some(expected), Some(found)) if expected != found => {
                let mut matching = self.matching_outputs(port).into_iter();
                let suggestion = matching.find(|name| !name.starts_with(&format!("{node}.")));
                Err(location.error(format!(
                    "`{input}` of `{node}` expects {expected:?}, and `{output}` is {found:?}{}",
                    suggestion.map_or(String::new(), |name| format!("; `{name}` matches"))
                )))
            }
            _ => Ok(()),
        }
    }

    fn output_name(&self, OutputRef { node, port }: OutputRef) -> String {
        let EnabledNode { entry, kind, .. } = &self.nodes[node];
        format!("{}.{}", entry.name.value, kind.outputs[port].name)
    }

    fn unconnected(
        &self,
        node: &EnabledNode<'_>,
        port: &Port,
        connection: Option<&Connection>,
    ) -> PipelineError {
        let (name, input) = (&node.entry.name.value, port.name);
        if let Some((location, outputs)) = connection.filter(|(_, outputs)| !outputs.is_empty()) {
            let outputs: Vec<&str> = outputs.iter().map(|output| output.value.as_str()).collect();
            return location.error(format!(
                "required input `{input}` of `{name}` is not connected: `{}` is disabled with these parameters; add another output to the list",
                outputs.join("`, `")
            ));
        }
        let hint = match self.matching_outputs(port).first() {
            None => format!("add a node with a {} output", port.kind.name()),
            Some(output) => format!("add \"{input}\": \"{output}\""),
        };
        let problem =
            format!("required input `{input}` of `{name}` ({}) is not connected: {hint}", port.about);
        node.entry.name.error(problem)
    }

    /// Returns the outputs that an input accepts, those with the name of the input first.
    fn matching_outputs(&self, port: &Port) -> Vec<String> {
        let outputs = self.nodes.iter().flat_map(|node| {
            let matching = node.kind.outputs.iter().filter(|output| {
                output.kind == port.kind && (output.format == port.format || port.format.is_none())
            });
            matching.map(move |output| format!("{}.{}", node.entry.name.value, output.name))
        });
        let mut outputs: Vec<String> = outputs.collect();
        outputs.sort_by_key(|output| !output.ends_with(&format!(".{}", port.name)));
        outputs
    }

    /// Finds the first of the named outputs whose node is enabled.
    fn find(&self, port: &str, (_, outputs): &Connection) -> Result<Option<OutputRef>, PipelineError> {
        let mut found = None;
        for name in outputs {
            let output = self.look_up(port, name)?;
            found = found.or(output);
        }
        Ok(found)
    }

    /// Finds an output by name; `None` if its node is disabled.
    fn look_up(&self, port: &str, name: &Spanned<String>) -> Result<Option<OutputRef>, PipelineError> {
        let (node, output) = match name.value.split_once('.') {
            Some((node, output)) => (node, Some(output)),
            None => (name.value.as_str(), None),
        };
        let Some(index) = self.nodes.iter().position(|known| known.entry.name.value == node) else {
            let known = || self.document.nodes.iter().map(|entry| entry.name.value.as_str());
            if known().any(|known| known == node) {
                return Ok(None);
            }
            return Err(name.error(format!("unknown node `{node}`{}", did_you_mean(node, known()))));
        };
        let outputs = self.nodes[index].kind.outputs;
        let names = || outputs.iter().map(|port| port.name);
        let wanted = match output {
            Some(output) => Some(output),
            None if outputs.len() == 1 => Some(outputs[0].name),
            None => names().find(|name| *name == port),
        };
        let Some(wanted) = wanted else {
            let all: Vec<&str> = names().collect();
            let problem = match all.first() {
                None => format!("`{node}` has no outputs"),
                Some(first) => {
                    format!(
                        "`{node}` has the outputs {}: name one, such as \"{node}.{first}\"",
                        all.join(" and ")
                    )
                }
            };
            return Err(name.error(problem));
        };
        match names().position(|name| name == wanted) {
            Some(port) => Ok(Some(OutputRef { node: index, port })),
            None => {
                let hint = did_you_mean(wanted, names());
                Err(name.error(format!("unknown output `{wanted}` of `{node}`{hint}")))
            }
        }
    }

    /// Connects the outputs of the pipeline.
    pub(super) fn outputs(
        &self,
        file: &str,
        in_place: &InPlaceNodes,
    ) -> Result<Vec<(&'static str, OutputRef)>, PipelineError> {
        let mut found = Vec::new();
        for connection in &self.document.outputs {
            let (name, _) = connection;
            let Some(known) = OUTPUTS.iter().find(|known| **known == name.value) else {
                let hint = did_you_mean(&name.value, OUTPUTS.iter().copied());
                return Err(name.error(format!("unknown output `{}` of a pipeline{hint}", name.value)));
            };
            let Some(output) = self.find(known, connection)? else { continue };
            self.check_output(name, known, output)?;
            if let Some(last) = in_place.last(self.nodes, self.nodes[output.node].first_value + output.port) {
                let (overwritten, last) =
                    (self.output_name(output), self.output_name(OutputRef { node: last, port: 0 }));
                return Err(name.error(format!(
                    "`{overwritten}` is overwritten in place: name `{last}` or an output of a later node"
                )));
            }
            found.push((*known, output));
        }
        if found.is_empty() {
            let problem = "missing outputs: add outputs: {\"image\": \"...\"} with the output of a node";
            return Err(PipelineError { location: file.into(), problem: problem.into() });
        }
        Ok(found)
    }

    fn check_output(
        &self,
        name: &Spanned<String>,
        known: &str,
        output: OutputRef,
    ) -> Result<(), PipelineError> {
        let port = self.nodes[output.node].kind.outputs[output.port];
        let output = self.output_name(output);
        if port.kind != PortKind::Texture {
            let found = port.kind.name();
            return Err(name.error(format!("`{known}` expects a texture, and `{output}` is a {found}")));
        }
        match port.format.filter(|format| known == "image" && !format.is_srgb()) {
            None => Ok(()),
            Some(format) => Err(name.error(format!(
                "`image` expects an sRGB format, and `{output}` is {format:?}: add a `tonemap` node after it"
            ))),
        }
    }
}
