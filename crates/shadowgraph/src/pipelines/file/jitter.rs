//! A camera that jitters and temporal anti-aliasing belong together.

use super::document::{Document, Entry};
use super::resolve::{Placed, Resolved};
use super::source::{PipelineError, Place};
use crate::nodes::{Node, Nodes, Port, PortKind, TaaNode, ViewNode};

impl Document {
    /// Tells of temporal anti-aliasing that sees each pixel from the same place in every frame, and of a camera that jitters
    /// for nothing.
    pub(super) fn jitter_alone(&self, there: &Resolved) -> Vec<PipelineError> {
        let of_kind = |kind: &'static str| there.nodes.iter().filter(move |node| node.kind.name == kind);
        let built_in = Nodes::built_in();
        // A kind that is not ours may mix frames too.
        let only_ours = there.nodes.iter().all(|node| built_in.get(node.kind.name).is_some());
        let mut told = Vec::new();
        for view in of_kind(ViewNode::NAME) {
            let through = there.through(view);
            let mut mixing =
                of_kind(TaaNode::NAME).filter(|taa| through.contains(&taa.name.as_str())).peekable();
            let jitters = view.settings.toggle(ViewNode::JITTER).unwrap_or_default();
            if jitters && mixing.peek().is_none() && only_ours {
                let problem = format!(
                    "`{}` jitters and no `taa` takes it, so edges swim: add one, or take the setting out",
                    view.name
                );
                told.extend(self.entry(view).map(|entry| jitter_of(entry).error(&problem)));
            }
            if !jitters {
                told.extend(mixing.filter_map(|taa| {
                    let problem = format!(
                        "`{}` (taa) smooths no edge without jitter: give `{}` settings: {{\"jitter\": true}}",
                        taa.name, view.name
                    );
                    Some(self.entry(taa)?.name.place.error(problem))
                }));
            }
        }
        told
    }

    fn entry(&self, node: &Placed) -> Option<&Entry> {
        self.nodes.iter().find(|entry| entry.name.value == node.name)
    }
}

impl Resolved {
    /// The nodes that look through a view's camera, by way of others too that pass it on.
    fn through(&self, view: &Placed) -> Vec<&str> {
        let cameras = |ports: &[(Port, usize)]| {
            let of_kind = ports.iter().filter(|(port, _)| port.kind == PortKind::View);
            of_kind.map(|(_, place)| *place).collect::<Vec<_>>()
        };
        let (mut places, mut names) = (cameras(&view.outputs), Vec::new());
        for node in &self.nodes {
            if node.inputs.iter().any(|(_, place)| place.is_some_and(|place| places.contains(&place))) {
                places.extend(cameras(&node.outputs));
                names.push(node.name.as_str());
            }
        }
        names
    }
}

fn jitter_of(entry: &Entry) -> &Place {
    let setting = entry.settings.iter().find(|(name, _)| name.value == ViewNode::JITTER);
    setting.map_or(&entry.name.place, |(name, _)| &name.place)
}
