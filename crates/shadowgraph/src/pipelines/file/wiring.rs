//! A resolved file as what adds passes to frames.

use shadowgraph_core::{Frame, Texture};
use shadowgraph_lighting::ViewBuffers;

use super::resolve::{Placed, Resolved};
use crate::Error;
use crate::nodes::{AnyNode, Need, Ports, Value};
use crate::pipelines::{Build, Output, View, Wiring};

/// Nodes with what they keep from frame to frame.
pub(super) struct FileWiring {
    resolved: std::sync::Arc<Resolved>,
    nodes: Vec<Box<dyn AnyNode>>,
}

impl FileWiring {
    pub(super) fn new(resolved: std::sync::Arc<Resolved>, build: &Build<'_>) -> Result<Self, Error> {
        let make = |node: &Placed| (node.kind.make)(build, &node.settings);
        Ok(Self { nodes: resolved.nodes.iter().map(make).collect::<Result<_, _>>()?, resolved })
    }
}

impl Wiring for FileWiring {
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error> {
        let Resolved { nodes, picture, picture_at, light_at, depth_at, values } = &*self.resolved;
        let mut values: Vec<Option<Value<'f>>> = (0..*values).map(|_| None).collect();
        for (at, (placed, node)) in nodes.iter().zip(&self.nodes).enumerate() {
            let mut ports = Ports {
                kind: placed.kind.name,
                node: &placed.name,
                view,
                inputs: &placed.inputs,
                outputs: &placed.outputs,
                values: &mut values,
                picture: (at == picture.0).then_some(picture.1),
            };
            if placed.kind.groups_itself {
                node.add(frame, view, &mut ports)?;
            } else {
                frame.node(&*placed.name, |frame| node.add(frame, view, &mut ports))?;
            }
            check_outputs(placed, &values)?;
        }
        let texture = |place: usize| match values.get(place) {
            Some(Some(Value::Texture(texture))) => Some(texture.clone()),
            _ => None,
        };
        let (light, depth) = (light_at.and_then(texture), depth_at.and_then(texture));
        let picture: Texture = texture(*picture_at)
            .ok_or_else(|| Error::Unfed { node: "the pipeline".into(), port: "picture".into() })?;
        let (mut buffers, mut shadows): (Option<ViewBuffers>, _) = (None, None);
        for value in values.into_iter().flatten() {
            match value {
                Value::View(view) => buffers = buffers.or(Some(view)),
                Value::Shadows(of_node) => shadows = shadows.or(Some(of_node)),
                _ => {}
            }
        }
        Ok(Output { picture, light, depth, view: buffers, shadows: shadows.unwrap_or_default() })
    }
}

/// A node that leaves an output empty that is always there is wrong.
fn check_outputs(placed: &Placed, values: &[Option<Value<'_>>]) -> Result<(), Error> {
    let wrong = |fault| Error::NodeKind { kind: placed.kind.name, fault };
    for (port, place) in &placed.outputs {
        match &values[*place] {
            None if port.need == Need::Required => {
                return Err(wrong(format!("it left its output `{}` empty", port.name)));
            }
            Some(value) if value.kind() != port.kind => {
                let (is, said) = (value.kind().name(), port.kind.name());
                return Err(wrong(format!(
                    "its output `{}` is a {is}, and it describes a {said}",
                    port.name
                )));
            }
            _ => {}
        }
    }
    Ok(())
}
