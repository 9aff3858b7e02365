//! What feeds what: names become places, and nodes an order.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use super::choose::{Chosen, parameter_of};
use super::document::{Document, Entry, Feed};
use super::source::{PipelineError, Spot};
use crate::nodes::{Need, NodeKind, Nodes, Port, Settings, near_words};

/// A node that is there, with the places of the values at its ports.
pub(super) struct Placed {
    pub(super) name: String,
    pub(super) kind: NodeKind,
    pub(super) settings: Settings,
    pub(super) inputs: Vec<(Port, Option<usize>)>,
    pub(super) outputs: Vec<(Port, usize)>,
}

/// The nodes in order, and where the pipeline's outputs come from.
pub(super) struct Resolved {
    pub(super) nodes: Vec<Placed>,
    /// The node and the name of its output.
    pub(super) picture: (usize, &'static str),
    /// Places of values.
    pub(super) picture_at: usize,
    pub(super) light_at: Option<usize>,
    pub(super) depth_at: Option<usize>,
    pub(super) values: usize,
}

/// What a file can name as its outputs.
const OUTPUTS: &[&str] = &["picture", "light", "depth"];

/// A node of the document that is there, before anything is connected.
struct Present<'d> {
    entry: &'d Entry,
    kind: NodeKind,
    /// The place of its first output's value.
    first: usize,
}

impl Document {
    /// Connects the nodes that are there.
    pub(super) fn resolve(
        &self,
        name: &str,
        nodes: &Nodes,
        chosen: &Chosen<'_>,
    ) -> Result<Resolved, PipelineError> {
        self.check_kinds(nodes)?;
        let mut present: Vec<Present<'_>> = Vec::new();
        let mut values = 0;
        for entry in &self.nodes {
            let here = entry.when.as_ref().is_none_or(|when| chosen.holds(&when.value));
            if let Some(kind) = nodes.get(&entry.kind.value).filter(|_| here) {
                present.push(Present { entry, kind: *kind, first: values });
                values += kind.outputs.len();
            }
        }
        let wires = Wires { document: self, present: &present };
        let inputs = present.iter().map(|node| wires.inputs(node)).collect::<Result<Vec<_>, _>>()?;
        let takers = takers(&present, &inputs)?;
        let order = order(&present, &inputs, &takers)?;
        let outputs = wires.outputs(name)?;
        for &(output, node, port) in &outputs {
            let place = present[node].first + port;
            let taker =
                |place| takers.iter().find(|(taken, _)| *taken == place).map(|(_, taker)| &present[*taker]);
            let mut last = taker(place);
            while let Some(next) = last.and_then(|node| taker(node.first)) {
                last = Some(next);
            }
            if let Some(last) = last {
                return Err(wires.taken_output(output, &present[node], port, last));
            }
        }
        let mut placed = Vec::new();
        for &index in &order {
            let Present { entry, kind, first } = &present[index];
            placed.push(Placed {
                name: entry.name.value.clone(),
                kind: *kind,
                settings: settings(entry, kind, chosen)?,
                inputs: inputs[index].iter().map(|(port, at, _)| (*port, *at)).collect(),
                outputs: kind.outputs.iter().enumerate().map(|(at, port)| (*port, first + at)).collect(),
            });
        }
        let at = |wanted: &str| outputs.iter().find(|(name, ..)| *name == wanted).copied();
        let Some((_, node, output)) = at("picture") else {
            let problem = "its outputs name no `picture`: say which node's output is to be seen";
            return Err(PipelineError { place: name.into(), problem: problem.into() });
        };
        let place = |(_, node, output): (&str, usize, usize)| present[node].first + output;
        Ok(Resolved {
            picture: (
                order.iter().position(|&index| index == node).unwrap_or_default(),
                present[node].kind.outputs[output].name,
            ),
            picture_at: present[node].first + output,
            light_at: at("light").map(place),
            depth_at: at("depth").map(place),
            nodes: placed,
            values,
        })
    }

    /// Checks what does not depend on what is there.
    fn check_kinds(&self, nodes: &Nodes) -> Result<(), PipelineError> {
        for (at, entry) in self.nodes.iter().enumerate() {
            let name = &entry.name;
            if name.value.is_empty() || name.value.contains(['.', '/', '$']) {
                return Err(
                    name.error(format!("`{}` is no name of a node: give it one without . / $", name.value))
                );
            }
            if let Some(other) = self.nodes[..at].iter().find(|other| other.name.value == name.value) {
                let place = other.name.place.words();
                return Err(name.error(format!(
                    "there is a node `{}` already, at {place}: call it otherwise",
                    name.value
                )));
            }
            let Some(kind) = nodes.get(&entry.kind.value) else {
                let near = near_words(&entry.kind.value, nodes.kinds().iter().map(|kind| kind.name));
                return Err(entry
                    .kind
                    .error(format!("there is no kind of node `{}`{near}", entry.kind.value)));
            };
            for (input, _) in &entry.inputs {
                if !kind.inputs.iter().any(|port| port.name == input.value) {
                    let near = near_words(&input.value, kind.inputs.iter().map(|port| port.name));
                    let (name, input_name) = (&name.value, &input.value);
                    return Err(
                        input.error(format!("`{name}` ({}) has no input `{input_name}`{near}", kind.name))
                    );
                }
            }
            for (setting, _) in &entry.settings {
                if !kind.settings.iter().any(|known| known.name == setting.value) {
                    let near = near_words(&setting.value, kind.settings.iter().map(|known| known.name));
                    let (name, own) = (&name.value, &setting.value);
                    return Err(
                        setting.error(format!("`{name}` ({}) has no setting `{own}`{near}", kind.name))
                    );
                }
            }
        }
        Ok(())
    }
}

struct Wires<'w, 'd> {
    document: &'d Document,
    present: &'w [Present<'d>],
}

/// An input, the place of its value, and the node that gives it.
type Wired = (Port, Option<usize>, Option<usize>);

impl Wires<'_, '_> {
    fn inputs(&self, node: &Present<'_>) -> Result<Vec<Wired>, PipelineError> {
        let mut wired = Vec::new();
        for port in node.kind.inputs {
            let feed = node.entry.inputs.iter().find(|(name, _)| name.value == port.name);
            let from = feed.map(|feed| self.source(port.name, feed)).transpose()?.flatten();
            let Some((giver, output)) = from else {
                if port.need == Need::Required {
                    return Err(self.unfed(node, port, feed));
                }
                wired.push((*port, None, None));
                continue;
            };
            let given = self.present[giver].kind.outputs[output];
            let place = feed.map_or(&node.entry.name.place, |(name, _)| &name.place);
            if given.kind != port.kind {
                return Err(place.error(format!(
                    "`{}` of `{}` takes a {}, and `{}.{}` is a {}",
                    port.name,
                    node.entry.name.value,
                    port.kind.name(),
                    self.present[giver].entry.name.value,
                    given.name,
                    given.kind.name()
                )));
            }
            if let (Some(wanted), Some(has)) = (port.format, given.format)
                && wanted != has
            {
                let (own, of) = (&node.entry.name.value, &self.present[giver].entry.name.value);
                let mut fitting = self.fitting(port).into_iter();
                let fits = fitting.find(|fits| !fits.starts_with(&format!("{own}.")));
                return Err(place.error(format!(
                    "`{}` of `{own}` takes {wanted:?}, and `{of}.{}` has {has:?}{}",
                    port.name,
                    given.name,
                    fits.map_or(String::new(), |fits| format!("; `{fits}` fits"))
                )));
            }
            wired.push((*port, Some(self.present[giver].first + output), Some(giver)));
        }
        Ok(wired)
    }

    fn unfed(&self, node: &Present<'_>, port: &Port, feed: Option<&Feed>) -> PipelineError {
        let name = &node.entry.name.value;
        if let Some((input, from)) = feed {
            let from: Vec<&str> = from.iter().map(|from| from.value.as_str()).collect();
            return input.error(format!(
                "input `{}` of `{name}` has to be fed, and `{}` is not there with these parameters: name another after it, in a list",
                port.name, from.join("`, `")
            ));
        }
        let givers = self.fitting(port);
        let way_out = if givers.is_empty() {
            format!("add a node that gives a {}", port.kind.name())
        } else {
            format!("such as \"{}\": \"{}\"", port.name, givers[0])
        };
        node.entry
            .name
            .error(format!("input `{}` of `{name}` ({}) has to be fed, {way_out}", port.name, port.about))
    }

    /// The outputs that fit a port; first those that are called as it is, which are likelier meant.
    fn fitting(&self, port: &Port) -> Vec<String> {
        let givers = self.present.iter().flat_map(|giver| {
            let fits = giver.kind.outputs.iter().filter(|output| {
                output.kind == port.kind && (output.format == port.format || port.format.is_none())
            });
            fits.map(move |output| format!("{}.{}", giver.entry.name.value, output.name))
        });
        let mut givers: Vec<String> = givers.collect();
        givers.sort_by_key(|giver| !giver.ends_with(&format!(".{}", port.name)));
        givers
    }

    /// The first of what is named that is there: the node among those present, and its output.
    fn source(&self, input: &str, (_, from): &Feed) -> Result<Option<(usize, usize)>, PipelineError> {
        let mut found = None;
        for reference in from {
            let place = self.look_up(input, reference)?;
            found = found.or(place);
        }
        Ok(found)
    }

    /// `None` for a node that is not there.
    fn look_up(&self, input: &str, from: &Spot<String>) -> Result<Option<(usize, usize)>, PipelineError> {
        let (node, output) = match from.value.split_once('.') {
            Some((node, output)) => (node, Some(output)),
            None => (from.value.as_str(), None),
        };
        let Some(at) = self.present.iter().position(|known| known.entry.name.value == node) else {
            let mut known = self.document.nodes.iter().map(|entry| entry.name.value.as_str());
            if known.clone().any(|known| known == node) {
                return Ok(None);
            }
            let near = near_words(node, &mut known);
            return Err(from.error(format!("there is no node `{node}`{near}")));
        };
        let outputs = self.present[at].kind.outputs;
        let names = || outputs.iter().map(|port| port.name);
        let wanted = match output {
            Some(output) => Some(output),
            None if outputs.len() == 1 => Some(outputs[0].name),
            None => names().find(|name| *name == input),
        };
        let Some(wanted) = wanted else {
            let all: Vec<&str> = names().collect();
            let first = all.first().copied().unwrap_or_default();
            let problem = match all.is_empty() {
                true => format!("`{node}` gives nothing"),
                false => {
                    format!("`{node}` gives {}: say which, such as \"{node}.{first}\"", all.join(" and "))
                }
            };
            return Err(from.error(problem));
        };
        match names().position(|name| name == wanted) {
            Some(output) => Ok(Some((at, output))),
            None => {
                let near = near_words(wanted, names());
                Err(from.error(format!("`{node}` has no output `{wanted}`{near}")))
            }
        }
    }

    /// `last` is the last of the nodes that draw over a node's output.
    fn taken_output(
        &self,
        output: &str,
        node: &Present<'_>,
        port: usize,
        last: &Present<'_>,
    ) -> PipelineError {
        let feed = self.document.outputs.iter().find(|(name, _)| name.value == output);
        let place = feed.map_or(&node.entry.name.place, |(name, _)| &name.place);
        let name = |node: &Present<'_>, port: usize| {
            format!("{}.{}", node.entry.name.value, node.kind.outputs[port].name)
        };
        let (taken, right) = (name(node, port), name(last, 0));
        place
            .error(format!("`{taken}` is drawn over: name \"{right}\", or an output of what comes behind it"))
    }

    fn outputs(&self, file: &str) -> Result<Vec<(&'static str, usize, usize)>, PipelineError> {
        let mut found = Vec::new();
        for feed in &self.document.outputs {
            let (name, _) = feed;
            let Some(known) = OUTPUTS.iter().find(|known| **known == name.value) else {
                let near = near_words(&name.value, OUTPUTS.iter().copied());
                return Err(name.error(format!("a pipeline has no output `{}`{near}", name.value)));
            };
            let Some((node, output)) = self.source(known, feed)? else { continue };
            let port = self.present[node].kind.outputs[output];
            if port.kind != crate::nodes::PortKind::Texture {
                return Err(name.error(format!("`{known}` is a texture, and `{}` is not one", port.name)));
            }
            if let Some(format) = port.format.filter(|format| *known == "picture" && !format.is_srgb()) {
                let of = &self.present[node].entry.name.value;
                return Err(name.error(format!(
                    "`picture` is what is seen, and `{of}.{}` has {format:?}: put a `tonemap` behind it",
                    port.name
                )));
            }
            found.push((*known, node, output));
        }
        if found.is_empty() {
            let problem =
                "it has no outputs: say which node's output is to be seen, outputs: {\"picture\": \"...\"}";
            return Err(PipelineError { place: file.into(), problem: problem.into() });
        }
        Ok(found)
    }
}

fn settings(entry: &Entry, kind: &NodeKind, chosen: &Chosen<'_>) -> Result<Settings, PipelineError> {
    let mut values = Vec::new();
    for setting in kind.settings {
        let given = entry.settings.iter().find(|(name, _)| name.value == setting.name);
        let value =
            given.map_or_else(|| setting.default_value(), |(_, value)| chosen.value(&value.value).clone());
        if let (Some(fault), Some((_, spot))) = (setting.fault(&value), given) {
            let by = parameter_of(&spot.value).map(|name| format!(", by the parameter `{name}`"));
            return Err(spot.error(format!("`{}`: {fault}{}", entry.name.value, by.unwrap_or_default())));
        }
        values.push((setting.name, value));
    }
    Ok(Settings::new(kind.name, values))
}

/// The places of values that are drawn over, and the nodes that do.
fn takers(present: &[Present<'_>], inputs: &[Vec<Wired>]) -> Result<Vec<(usize, usize)>, PipelineError> {
    let mut takers: Vec<(usize, usize)> = Vec::new();
    for (index, inputs) in inputs.iter().enumerate() {
        for (port, place, _) in inputs.iter().filter(|(port, ..)| port.taken) {
            let Some(place) = *place else { continue };
            if let Some((_, other)) = takers.iter().find(|(taken, _)| *taken == place) {
                let (own, other) = (&present[index].entry.name, &present[*other].entry.name.value);
                return Err(own.error(format!(
                    "`{}` draws over what feeds its `{}`, and so does `{other}`: feed one of them from the other",
                    own.value, port.name
                )));
            }
            takers.push((place, index));
        }
    }
    Ok(takers)
}

/// Nodes behind all that feed them; of those ready, the first of the file.
fn order(
    present: &[Present<'_>],
    inputs: &[Vec<Wired>],
    takers: &[(usize, usize)],
) -> Result<Vec<usize>, PipelineError> {
    let mut graph: DiGraph<usize, ()> = DiGraph::new();
    let nodes: Vec<NodeIndex> = (0..present.len()).map(|index| graph.add_node(index)).collect();
    for (index, inputs) in inputs.iter().enumerate() {
        for giver in inputs.iter().filter_map(|(.., giver)| *giver) {
            graph.update_edge(nodes[giver], nodes[index], ());
        }
    }
    // What is drawn over is read before.
    for (index, inputs) in inputs.iter().enumerate() {
        for place in inputs.iter().filter_map(|(_, place, _)| *place) {
            let taker = takers.iter().find(|(taken, taker)| *taken == place && *taker != index);
            if let Some((_, taker)) = taker {
                graph.update_edge(nodes[index], nodes[*taker], ());
            }
        }
    }
    let is_cycle = |part: &&Vec<NodeIndex>| part.len() > 1 || graph.contains_edge(part[0], part[0]);
    if let Some(cycle) = tarjan_scc(&graph).iter().find(is_cycle) {
        return Err(cycle_error(present, &graph, cycle));
    }
    let mut waiting: Vec<usize> =
        nodes.iter().map(|node| graph.neighbors_directed(*node, petgraph::Incoming).count()).collect();
    let mut ready: BinaryHeap<Reverse<usize>> =
        (0..present.len()).filter(|index| waiting[*index] == 0).map(Reverse).collect();
    let mut order = Vec::new();
    while let Some(Reverse(index)) = ready.pop() {
        order.push(index);
        for next in graph.neighbors(nodes[index]) {
            let next = graph[next];
            waiting[next] -= 1;
            if waiting[next] == 0 {
                ready.push(Reverse(next));
            }
        }
    }
    Ok(order)
}

/// Tells the nodes of a cycle in the order in which they feed each other, from the first of the file.
fn cycle_error(present: &[Present<'_>], graph: &DiGraph<usize, ()>, cycle: &[NodeIndex]) -> PipelineError {
    let first = cycle.iter().copied().min_by_key(|node| graph[*node]).unwrap_or(cycle[0]);
    // From each node on to one of the cycle that was not seen yet, until it closes.
    let (mut path, mut at) = (vec![first], first);
    loop {
        let mut next = graph.neighbors(at).filter(|node| cycle.contains(node));
        let fresh = next.clone().filter(|node| !path.contains(node)).min_by_key(|node| graph[*node]);
        match fresh {
            Some(node) if !next.any(|node| node == first) || path.len() < 2 => {
                path.push(node);
                at = node;
            }
            _ => break,
        }
    }
    let name = |node: &NodeIndex| present[graph[*node]].entry.name.value.as_str();
    let names: Vec<&str> = path.iter().chain(std::iter::once(&first)).map(name).collect();
    let entry = &present[graph[first]].entry;
    let feeds = |from: &Spot<String>| from.value.split('.').next() == path.last().map(name);
    let closing = entry.inputs.iter().find(|(_, from)| from.iter().any(feeds));
    let place = closing.map_or(&entry.name, |(input, _)| input);
    place.error(format!(
        "nodes feed each other in a circle: {}; feed one of them from elsewhere",
        names.join(" -> ")
    ))
}
