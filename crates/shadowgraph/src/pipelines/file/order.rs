//! The order of nodes: producers before consumers, and what overwrites a value in place after all other consumers.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use petgraph::algo::tarjan_scc;
use petgraph::graph::{DiGraph, NodeIndex};

use super::enabled::{ConnectedInput, EnabledNode};
use super::source::Spanned;
use crate::error::PipelineError;

/// The values that are overwritten in place, and the nodes that overwrite them.
pub(super) struct InPlaceNodes(Vec<(usize, usize)>);

impl InPlaceNodes {
    /// Returns the node that overwrites a value.
    fn of_value(&self, value: usize) -> Option<usize> {
        self.0.iter().find(|(overwritten, _)| *overwritten == value).map(|(_, node)| *node)
    }

    /// Returns the last of the nodes that overwrite a value one after another.
    pub(super) fn last(&self, nodes: &[EnabledNode<'_>], value: usize) -> Option<usize> {
        let mut last = self.of_value(value);
        while let Some(next) = last.and_then(|node| self.of_value(nodes[node].first_value)) {
            last = Some(next);
        }
        last
    }
}

/// Finds the nodes that overwrite inputs in place.
pub(super) fn in_place_nodes(
    nodes: &[EnabledNode<'_>],
    inputs: &[Vec<ConnectedInput>],
) -> Result<InPlaceNodes, PipelineError> {
    let mut found = InPlaceNodes(Vec::new());
    for (index, inputs) in inputs.iter().enumerate() {
        for input in inputs.iter().filter(|input| input.port.in_place) {
            let Some(value) = input.value else { continue };
            if let Some(other) = found.of_value(value) {
                let (own, other) = (&nodes[index].entry.name, &nodes[other].entry.name.value);
                return Err(own.error(format!(
                    "`{}` overwrites its input `{}` in place, and so does `{other}`: connect one to the output of the other",
                    own.value, input.port.name
                )));
            }
            found.0.push((value, index));
        }
    }
    Ok(found)
}

/// Orders nodes after their producers; among those that are ready, the first of the file comes first.
pub(super) fn order(
    nodes: &[EnabledNode<'_>],
    inputs: &[Vec<ConnectedInput>],
    in_place: &InPlaceNodes,
) -> Result<Vec<usize>, PipelineError> {
    let graph = graph(inputs, in_place);
    let is_cycle = |part: &&Vec<NodeIndex>| part.len() > 1 || graph.contains_edge(part[0], part[0]);
    if let Some(cycle) = tarjan_scc(&graph).iter().find(is_cycle) {
        return Err(cycle_error(nodes, &graph, cycle));
    }
    let mut waiting: Vec<usize> =
        graph.node_indices().map(|node| graph.neighbors_directed(node, petgraph::Incoming).count()).collect();
    let mut ready: BinaryHeap<Reverse<usize>> =
        (0..nodes.len()).filter(|index| waiting[*index] == 0).map(Reverse).collect();
    let mut order = Vec::new();
    while let Some(Reverse(index)) = ready.pop() {
        order.push(index);
        for next in graph.neighbors(NodeIndex::new(index)) {
            waiting[next.index()] -= 1;
            if waiting[next.index()] == 0 {
                ready.push(Reverse(next.index()));
            }
        }
    }
    Ok(order)
}

/// Returns the graph of nodes, with an edge to each node that has to come later.
fn graph(inputs: &[Vec<ConnectedInput>], in_place: &InPlaceNodes) -> DiGraph<(), ()> {
    let mut graph: DiGraph<(), ()> = DiGraph::new();
    let nodes: Vec<NodeIndex> = inputs.iter().map(|_| graph.add_node(())).collect();
    for (index, inputs) in inputs.iter().enumerate() {
        for producer in inputs.iter().filter_map(|input| input.producer) {
            graph.update_edge(nodes[producer], nodes[index], ());
        }
    }
    // What is overwritten in place is read before.
    for (index, inputs) in inputs.iter().enumerate() {
        for value in inputs.iter().filter_map(|input| input.value) {
            if let Some(node) = in_place.of_value(value).filter(|node| *node != index) {
                graph.update_edge(nodes[index], nodes[node], ());
            }
        }
    }
    graph
}

/// Names the nodes of a cycle in the order of their connections, from the first of the file.
fn cycle_error(nodes: &[EnabledNode<'_>], graph: &DiGraph<(), ()>, cycle: &[NodeIndex]) -> PipelineError {
    let first = cycle.iter().copied().min().unwrap_or(cycle[0]);
    // From each node to one of the cycle that was not visited yet, until the cycle closes.
    let (mut path, mut last) = (vec![first], first);
    loop {
        let mut next = graph.neighbors(last).filter(|node| cycle.contains(node));
        let unvisited = next.clone().filter(|node| !path.contains(node)).min();
        match unvisited {
            Some(node) if !next.any(|node| node == first) || path.len() < 2 => {
                path.push(node);
                last = node;
            }
            _ => break,
        }
    }
    let name = |node: &NodeIndex| nodes[node.index()].entry.name.value.as_str();
    let names: Vec<&str> = path.iter().chain(std::iter::once(&first)).map(name).collect();
    let entry = nodes[first.index()].entry;
    let closes = |output: &Spanned<String>| output.value.split('.').next() == path.last().map(name);
    let closing = entry.inputs.iter().find(|(_, outputs)| outputs.iter().any(closes));
    let input = closing.map_or(&entry.name, |(input, _)| input);
    input.error(format!("cycle in the node graph: {}", names.join(" -> ")))
}
