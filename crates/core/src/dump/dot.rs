//! The plan as a Graphviz graph: a cluster for each node, a box for each pass, an edge for each dependency.

use super::describe::Positions;
use crate::handle::{NodeId, PassId};
use crate::plan::{DependencyKind, Plan};
use std::fmt::Write as _;

const HEAD: &str = "digraph frame {\n  rankdir=LR;\n  fontname=\"sans-serif\";\n  node [shape=box, \
                    style=\"rounded,filled\", fillcolor=\"#eef3fa\", fontname=\"sans-serif\"];\n  edge \
                    [fontname=\"sans-serif\", fontsize=10];\n";

/// Fill colours of passes that share a render pass; neighbouring groups differ.
const GROUPS: [&str; 4] = ["#ffe2b8", "#d5ecc2", "#f6cfd8", "#d9d2f0"];

impl Plan {
    /// Returns the plan in Graphviz's DOT language. Passes of one render pass share a colour and are connected by thick
    /// lines. Culled passes are faint; tooltips explain the decisions about a pass.
    pub fn to_dot(&self) -> String {
        let positions = Positions::new(self);
        let mut out = String::from(HEAD);
        self.dot_members(&mut out, &positions, None, 1);
        for dependency in self.dependencies() {
            let style = match dependency.kind {
                DependencyKind::ReadAfterWrite => "",
                _ => ", style=dotted, constraint=false",
            };
            let name = match dependency.resource {
                Some(id) => escape(self.resource(id).name),
                None => "after".into(),
            };
            let (before, after) = (dependency.before.0, dependency.after.0);
            let why = escape(&self.explain_dependency(dependency));
            let _ = writeln!(out, "  p{before} -> p{after} [label=\"{name}\", tooltip=\"{why}\"{style}];");
        }
        for step in self.steps() {
            for pair in step.passes.windows(2) {
                let [before, after] = [pair[0].0, pair[1].0];
                let _ = writeln!(
                    out,
                    "  p{before} -> p{after} [dir=none, penwidth=5, color=\"#e08a1e\", constraint=false, \
                     tooltip=\"one render pass\"];"
                );
            }
        }
        out.push_str("}\n");
        out
    }

    /// Writes the passes and nodes directly inside `parent`.
    fn dot_members(&self, out: &mut String, positions: &Positions, parent: Option<NodeId>, depth: usize) {
        let indent = "  ".repeat(depth);
        for (id, _) in self.passes().filter(|(_, p)| p.node == parent) {
            let _ = writeln!(out, "{indent}p{} [{}];", id.index(), self.dot_pass(positions, id));
        }
        for (index, node) in self.nodes().enumerate().filter(|(_, n)| n.parent == parent) {
            let _ = writeln!(out, "{indent}subgraph cluster_{index} {{");
            let _ = writeln!(out, "{indent}  label=\"{}\"; color=\"#8aa0b8\";", escape(node.name));
            self.dot_members(out, positions, Some(NodeId(index as u32)), depth + 1);
            let _ = writeln!(out, "{indent}}}");
        }
    }

    fn dot_pass(&self, positions: &Positions, id: PassId) -> String {
        let pass = self.pass(id);
        let (label, kind) = (escape(pass.name), pass.kind.as_str());
        let Some(position) = positions.get(id) else {
            let why = pass.culled.map(|reason| escape(&self.describe_cull(reason))).unwrap_or_default();
            return format!(
                "label=\"{label}\\nculled\", style=\"rounded,dashed\", color=gray, fontcolor=gray, tooltip=\"{why}\""
            );
        };
        let step = position.step;
        let why = escape(&self.explain_merge(position.order));
        let (merged, colour) = if position.passes > 1 {
            let count = format!(", {} of {}", position.within + 1, position.passes);
            (count, format!(", fillcolor=\"{}\"", GROUPS[step % GROUPS.len()]))
        } else {
            (String::new(), String::new())
        };
        let tooltip = if position.within > 0 { "merged" } else { "not merged" };
        format!("label=\"{label}\\n{kind}, step {step}{merged}\", tooltip=\"{tooltip}: {why}\"{colour}")
    }
}

fn escape(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', " ")
}
