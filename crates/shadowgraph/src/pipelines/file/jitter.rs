//! Warnings about jitter without temporal anti-aliasing, and the other way round.

use super::document::{Document, NodeEntry};
use super::resolve::{ResolvedNode, ResolvedPipeline};
use super::source::Location;
use crate::error::PipelineError;
use crate::nodes::built_in::taa::Taa;
use crate::nodes::built_in::view::ViewNode;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::registry::Nodes;

impl Document {
    /// Returns warnings about temporal anti-aliasing without jitter, and about a camera whose jitter nothing resolves.
    pub(super) fn jitter_warnings(&self, resolved: &ResolvedPipeline) -> Vec<PipelineError> {
        let of_kind = |kind: &'static str| resolved.nodes.iter().filter(move |node| node.kind.name == kind);
        let built_in = Nodes::built_in();
        // A kind of another crate may accumulate frames too.
        let only_built_in = resolved.nodes.iter().all(|node| built_in.get(node.kind.name).is_some());
        let mut warnings = Vec::new();
        for view in of_kind(ViewNode::NAME) {
            let users = resolved.camera_users(view);
            let mut temporal = of_kind(Taa::NAME).filter(|taa| users.contains(&taa.name.as_str())).peekable();
            let jitters = view.settings.toggle(ViewNode::JITTER).unwrap_or_default();
            if jitters && temporal.peek().is_none() && only_built_in {
                let problem = format!(
                    "`{}` jitters the camera without a `taa` node, so edges shimmer: add `taa` or remove the setting",
                    view.name
                );
                warnings.extend(self.entry(&view.name).map(|entry| jitter_location(entry).error(&problem)));
            }
            if !jitters {
                warnings.extend(temporal.filter_map(|taa| {
                    let problem = format!(
                        "`{}` (taa) has no effect on edges without jitter: add settings: {{\"jitter\": true}} to `{}`",
                        taa.name, view.name
                    );
                    Some(self.entry(&taa.name)?.name.error(problem))
                }));
            }
        }
        warnings
    }
}

impl ResolvedPipeline {
    /// Returns the nodes that use a view's camera, also through nodes that pass it on.
    fn camera_users(&self, view: &ResolvedNode) -> Vec<&str> {
        let cameras = |ports: &[(Port, usize)]| {
            let cameras = ports.iter().filter(|(port, _)| port.kind == PortKind::View);
            cameras.map(|(_, value)| *value).collect::<Vec<_>>()
        };
        let (mut values, mut names) = (cameras(&view.outputs), Vec::new());
        for node in &self.nodes {
            if node.inputs.iter().any(|(_, value)| value.is_some_and(|value| values.contains(&value))) {
                values.extend(cameras(&node.outputs));
                names.push(node.name.as_str());
            }
        }
        names
    }
}

fn jitter_location(entry: &NodeEntry) -> &Location {
    let setting = entry.settings.iter().find(|(name, _)| name.value == ViewNode::JITTER);
    setting.map_or(&entry.name.location, |(name, _)| &name.location)
}
