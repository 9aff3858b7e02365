//! A resolved file that is built for a device.

use std::sync::Arc;

use shadowgraph_core::{Frame, Texture};
use shadowgraph_lighting::ViewBuffers;

use super::resolve::{ResolvedNode, ResolvedPipeline};
use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::AnyNode;
use crate::nodes::port::{Presence, Value};
use crate::nodes::ports::Ports;
use crate::pipelines::instance::{PipelineInstance, PipelineOutput};
use crate::render_view::RenderView;

/// The nodes of a file, with what they keep from frame to frame.
pub(super) struct FileInstance {
    resolved: Arc<ResolvedPipeline>,
    nodes: Vec<Box<dyn AnyNode>>,
}

impl FileInstance {
    pub(super) fn new(resolved: Arc<ResolvedPipeline>, context: &BuildContext<'_>) -> Result<Self, Error> {
        let build = |node: &ResolvedNode| (node.kind.build)(context, &node.settings);
        Ok(Self { nodes: resolved.nodes.iter().map(build).collect::<Result<_, _>>()?, resolved })
    }
}

impl PipelineInstance for FileInstance {
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
    ) -> Result<PipelineOutput<'f>, Error> {
        let ResolvedPipeline { nodes, image_output, image, light, depth, is_read } = &*self.resolved;
        let mut values: Vec<Option<Value<'f>>> = is_read.iter().map(|_| None).collect();
        for (index, (resolved, node)) in nodes.iter().zip(&self.nodes).enumerate() {
            let mut ports = Ports {
                kind: resolved.kind.name,
                node: &resolved.name,
                view,
                inputs: &resolved.inputs,
                outputs: &resolved.outputs,
                values: &mut values,
                is_read,
                image: (index == image_output.0).then_some(image_output.1),
            };
            if resolved.kind.groups_itself {
                node.add(frame, view, &mut ports)?;
            } else {
                frame.node(&*resolved.name, |frame| node.add(frame, view, &mut ports))?;
            }
            check_outputs(resolved, &values)?;
        }
        let texture = |index: usize| match values.get(index) {
            Some(Some(Value::Texture(texture))) => Some(texture.clone()),
            _ => None,
        };
        let (light, depth) = (light.and_then(texture), depth.and_then(texture));
        let image: Texture = texture(*image)
            .ok_or_else(|| Error::Unconnected { node: "the pipeline".into(), port: "image".into() })?;
        let (mut buffers, mut shadows): (Option<ViewBuffers>, _) = (None, None);
        for value in values.into_iter().flatten() {
            match value {
                Value::View(view) => buffers = buffers.or(Some(view)),
                Value::Shadows(outputs) => shadows = shadows.or(Some(outputs)),
                _ => {}
            }
        }
        Ok(PipelineOutput { image, light, depth, view: buffers, shadows: shadows.unwrap_or_default() })
    }

    fn is_temporal(&self) -> bool {
        self.resolved.nodes.iter().any(|node| node.kind.temporal)
    }
}

/// Checks that a node has set its required outputs, with values of the declared kinds.
fn check_outputs(node: &ResolvedNode, values: &[Option<Value<'_>>]) -> Result<(), Error> {
    let error = |reason| Error::NodeKind { kind: node.kind.name, reason };
    for (port, index) in &node.outputs {
        match &values[*index] {
            None if port.presence == Presence::Required => {
                return Err(error(format!("it does not set its output `{}`", port.name)));
            }
            Some(value) if value.kind() != port.kind => {
                let (is, declared) = (value.kind().name(), port.kind.name());
                let problem = format!("its output `{}` is a {is}, and it declares a {declared}", port.name);
                return Err(error(problem));
            }
            _ => {}
        }
    }
    Ok(())
}
