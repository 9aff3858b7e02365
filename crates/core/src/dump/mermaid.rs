//! The plan as a Mermaid flowchart, which many sites render in documents.

use super::describe::Positions;
use crate::handle::NodeId;
use crate::plan::{DependencyKind, Plan};
use std::fmt::Write as _;

impl Plan {
    /// Returns the plan as a Mermaid flowchart: a subgraph for each node, a box for each pass, an arrow for each resource
    /// that a pass reads from an earlier one. Other dependencies are dotted; culled passes are dashed.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let mut frame = Frame::new();
    /// let mut scene = frame.create_texture("scene", TextureDesc::d2(64, 64, Format::Rgba16Float));
    /// frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
    /// frame.export_texture(&scene);
    /// assert!(frame.compile()?.plan().to_mermaid().starts_with("flowchart LR\n"));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn to_mermaid(&self) -> String {
        let positions = Positions::new(self);
        let mut out = String::from("flowchart LR\n  classDef culled stroke-dasharray: 4 3, opacity: 0.6\n");
        self.mermaid_members(&mut out, &positions, None, 1);
        for dependency in self.dependencies() {
            let name = match dependency.resource {
                Some(id) => escape(self.resource(id).name),
                None => "after".into(),
            };
            let (before, after) = (dependency.before.0, dependency.after.0);
            let arrow = if dependency.kind == DependencyKind::ReadAfterWrite { "-->" } else { "-.->" };
            let _ = writeln!(out, "  p{before} {arrow}|\"{name}\"| p{after}");
        }
        out
    }

    /// Writes the passes and nodes directly inside `parent`.
    fn mermaid_members(&self, out: &mut String, positions: &Positions, parent: Option<NodeId>, depth: usize) {
        let indent = "  ".repeat(depth);
        for (id, pass) in self.passes().filter(|(_, p)| p.node == parent) {
            let (name, index) = (escape(pass.name), id.index());
            let _ = match positions.get(id) {
                Some(position) => writeln!(out, "{indent}p{index}[\"{name}<br/>step {}\"]", position.step),
                None => writeln!(out, "{indent}p{index}[\"{name}<br/>culled\"]:::culled"),
            };
        }
        for (index, node) in self.nodes().enumerate().filter(|(_, n)| n.parent == parent) {
            let _ = writeln!(out, "{indent}subgraph n{index} [\"{}\"]", escape(node.name));
            self.mermaid_members(out, positions, Some(NodeId(index as u32)), depth + 1);
            let _ = writeln!(out, "{indent}end");
        }
    }
}

/// Replaces characters that would end a quoted string or be parsed as markup by Mermaid's entities.
fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for char in text.chars() {
        match char {
            '"' | '<' | '>' | '#' | '&' | ';' | '`' => {
                let _ = write!(out, "#{};", char as u32);
            }
            '\n' => out.push(' '),
            _ => out.push(char),
        }
    }
    out
}
