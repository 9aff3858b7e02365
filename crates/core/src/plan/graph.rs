//! The plan as a petgraph graph.

use super::{Dependency, Plan};
use crate::handle::PassId;
use petgraph::graph::DiGraph;

impl Plan {
    /// Returns the dependencies as a graph whose node indices are pass ids, for petgraph's algorithms.
    ///
    /// ```
    /// use petgraph::algo::is_cyclic_directed;
    /// let plan = shadowgraph_core::Frame::new().compile()?.into_plan();
    /// assert!(!is_cyclic_directed(&plan.graph()));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn graph(&self) -> DiGraph<PassId, Dependency> {
        let mut graph = DiGraph::with_capacity(self.pass_count(), self.dependencies.len());
        for index in 0..self.pass_count() {
            graph.add_node(PassId(index as u32));
        }
        for &dependency in &self.dependencies {
            graph.add_edge(dependency.before.0.into(), dependency.after.0.into(), dependency);
        }
        graph
    }

    /// Returns why `before` runs before `after`: the shortest chain of dependencies from one to the other, or `None`
    /// if nothing orders them.
    pub fn why_before(&self, before: PassId, after: PassId) -> Option<Vec<Dependency>> {
        let mut reached: Vec<Option<Dependency>> = vec![None; self.pass_count()];
        let graph = self.graph();
        let mut queue = std::collections::VecDeque::from([before]);
        while let Some(pass) = queue.pop_front() {
            if pass == after {
                break;
            }
            let mut edges: Vec<_> = graph.edges(pass.0.into()).map(|edge| *edge.weight()).collect();
            edges.sort_by_key(|edge| edge.after);
            for edge in edges {
                let seen = &mut reached[edge.after.index()];
                if seen.is_none() {
                    *seen = Some(edge);
                    queue.push_back(edge.after);
                }
            }
        }
        let mut chain = Vec::new();
        let mut at = after;
        while at != before {
            let edge = reached[at.index()]?;
            chain.push(edge);
            at = edge.before;
        }
        chain.reverse();
        Some(chain)
    }

    /// Returns the longest chain of passes that depend on each other, where `cost` is the weight of a pass,
    /// such as its measured milliseconds.
    pub fn critical_path(&self, cost: impl Fn(PassId) -> f64) -> Vec<PassId> {
        // Longest path to each pass, along the order, which is a topological one.
        let mut best: Vec<(f64, Option<PassId>)> = vec![(0.0, None); self.pass_count()];
        let mut incoming: Vec<Vec<PassId>> = vec![Vec::new(); self.pass_count()];
        for dependency in &self.dependencies {
            incoming[dependency.after.index()].push(dependency.before);
        }
        for &pass in &self.order {
            let before = incoming[pass.index()].iter().map(|&b| (best[b.index()].0, Some(b)));
            let longest = before.fold((0.0, None), |a, b| if b.0 > a.0 || a.1.is_none() { b } else { a });
            best[pass.index()] = (longest.0 + cost(pass), longest.1);
        }
        let last = self.order.iter().copied().fold(None, |a: Option<PassId>, b| match a {
            Some(a) if best[a.index()].0 >= best[b.index()].0 => Some(a),
            _ => Some(b),
        });
        let mut path: Vec<_> = std::iter::successors(last, |pass| best[pass.index()].1).collect();
        path.reverse();
        path
    }
}
