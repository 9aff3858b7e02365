//! The plan as a Graphviz graph: a cluster for each node, a box for each pass, an edge for each dependency.

use crate::handle::NodeId;
use crate::plan::{DependencyKind, Plan};
use std::fmt::Write as _;

impl Plan {
    /// Returns the plan in Graphviz's DOT language. Culled passes are faint, and their tooltips say why.
    pub fn to_dot(&self) -> String {
        let mut out = String::from(
            "digraph frame {\n  rankdir=LR;\n  fontname=\"sans-serif\";\n  node [shape=box, style=\"rounded,filled\", fillcolor=\"#eef3fa\", \
             fontname=\"sans-serif\"];\n  edge [fontname=\"sans-serif\", fontsize=10];\n",
        );
        self.dot_members(&mut out, None, 1);
        for dependency in &self.dependencies {
            let style = match dependency.kind {
                DependencyKind::ReadAfterWrite => "",
                _ => ", style=dotted, constraint=false",
            };
            let name = escape(&self.resource(dependency.resource).name);
            let (before, after) = (dependency.before.0, dependency.after.0);
            let _ = writeln!(out, "  p{before} -> p{after} [label=\"{name}\"{style}];");
        }
        out.push_str("}\n");
        out
    }

    /// Writes the passes and nodes directly inside `parent`.
    fn dot_members(&self, out: &mut String, parent: Option<NodeId>, depth: usize) {
        let indent = "  ".repeat(depth);
        for (index, pass) in self.passes.iter().enumerate().filter(|(_, p)| p.node == parent) {
            let (label, kind) = (escape(&pass.name), pass.kind.word());
            let _ = match pass.culled {
                None => writeln!(out, "{indent}p{index} [label=\"{label}\\n{kind}\"];"),
                Some(reason) => {
                    let why = escape(&self.cull_words(reason));
                    writeln!(
                        out,
                        "{indent}p{index} [label=\"{label}\\nculled\", style=\"rounded,dashed\", color=gray, \
                         fontcolor=gray, tooltip=\"{why}\"];"
                    )
                }
            };
        }
        for (index, node) in self.nodes.iter().enumerate().filter(|(_, n)| n.parent == parent) {
            let _ = writeln!(out, "{indent}subgraph cluster_{index} {{");
            let _ = writeln!(out, "{indent}  label=\"{}\"; color=\"#8aa0b8\";", escape(&node.name));
            self.dot_members(out, Some(NodeId(index as u32)), depth + 1);
            let _ = writeln!(out, "{indent}}}");
        }
    }
}

fn escape(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', " ")
}
