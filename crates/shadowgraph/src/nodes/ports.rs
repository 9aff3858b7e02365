//! A node's ports in one frame.

use shadowgraph_core::{Buffer, Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_lighting::{GBuffer, ViewBuffers};
use shadowgraph_shadows::{ShadowOutputs, SurfaceBuffers};

use super::port::{Port, Presence, Value};
use crate::error::Error;
use crate::render_view::RenderView;

/// The values at a node's inputs, and the slots of its outputs.
pub struct Ports<'n, 'f> {
    pub(crate) kind: &'static str,
    pub(crate) node: &'n str,
    pub(crate) view: &'f RenderView<'f>,
    /// The inputs with the indices of their values.
    pub(crate) inputs: &'n [(Port, Option<usize>)],
    /// The outputs with the indices of their values.
    pub(crate) outputs: &'n [(Port, usize)],
    pub(crate) values: &'n mut [Option<Value<'f>>],
    /// Of each value, whether a node or an output of the pipeline reads it.
    pub(crate) is_read: &'n [bool],
    /// The output that is the view's image, if it is one of these.
    pub(crate) image: Option<&'n str>,
}

impl<'f> Ports<'_, 'f> {
    fn value(&self, name: &str) -> Result<Option<&Value<'f>>, Error> {
        let (_, index) = self.inputs.iter().find(|(port, _)| port.name == name).ok_or_else(|| {
            let reason = format!("it reads an input `{name}` that it does not declare");
            Error::NodeKind { kind: self.kind, reason }
        })?;
        Ok(index.and_then(|index| self.values.get(index)?.as_ref()))
    }

    fn required(&self, name: &str) -> Result<&Value<'f>, Error> {
        self.value(name)?.ok_or_else(|| Error::Unconnected { node: self.node.into(), port: name.into() })
    }

    fn wrong_kind(&self, name: &str) -> Error {
        let reason = format!("it reads its input `{name}` as another kind of port than it declares");
        Error::NodeKind { kind: self.kind, reason }
    }

    /// Returns the texture at an input.
    ///
    /// # Errors
    /// [`Error::Unconnected`] if the frame has none; [`Error::NodeKind`] for an input that the node does not declare, or
    /// declares as another kind. The same holds for the functions below.
    pub fn texture(&self, name: &str) -> Result<Texture, Error> {
        match self.required(name)? {
            Value::Texture(texture) => Ok(texture.clone()),
            _ => Err(self.wrong_kind(name)),
        }
    }

    /// Returns the texture at an input; if it is not connected, its placeholder, which is black by default.
    ///
    /// # Errors
    /// [`Error::NodeKind`] as for [`texture`](Self::texture).
    pub fn texture_or_placeholder(&self, name: &str, frame: &mut Frame<'f>) -> Result<Texture, Error> {
        if self.value(name)?.is_some() {
            return self.texture(name);
        }
        let presence = self.inputs.iter().find(|(port, _)| port.name == name).map(|(port, _)| port.presence);
        let color = match presence {
            Some(Presence::Placeholder(color)) => color,
            _ => [0.0; 4],
        };
        let desc = TextureDesc::d2(1, 1, Format::Rgba8Unorm);
        let mut texel = frame.create_texture(format_args!("no {name}"), desc);
        frame.render_pass(format_args!("no {name}")).color(&mut texel, Contents::clear_color(color));
        Ok(texel)
    }

    /// Returns the buffer at an input.
    ///
    /// # Errors
    /// As [`texture`](Self::texture).
    pub fn buffer(&self, name: &str) -> Result<Buffer, Error> {
        match self.required(name)? {
            Value::Buffer(buffer) => Ok(buffer.clone()),
            _ => Err(self.wrong_kind(name)),
        }
    }

    /// Returns the camera and the lights at an input.
    ///
    /// # Errors
    /// As [`texture`](Self::texture).
    pub fn view(&self, name: &str) -> Result<ViewBuffers, Error> {
        match self.required(name)? {
            Value::View(view) => Ok(view.clone()),
            _ => Err(self.wrong_kind(name)),
        }
    }

    /// Returns the surfaces at an input; `None` if the frame has none.
    ///
    /// # Errors
    /// [`Error::NodeKind`] as for [`texture`](Self::texture).
    pub fn surfaces(&self, name: &str) -> Result<Option<SurfaceBuffers>, Error> {
        match self.value(name)? {
            None => Ok(None),
            Some(Value::Surfaces(surfaces)) => Ok(Some(surfaces.clone())),
            Some(_) => Err(self.wrong_kind(name)),
        }
    }

    /// Returns the shadows at an input.
    ///
    /// # Errors
    /// As [`texture`](Self::texture).
    pub fn shadows(&self, name: &str) -> Result<&ShadowOutputs<'f>, Error> {
        match self.required(name)? {
            Value::Shadows(shadows) => Ok(shadows),
            _ => Err(self.wrong_kind(name)),
        }
    }

    /// Returns the G-buffer at an input.
    ///
    /// # Errors
    /// As [`texture`](Self::texture).
    pub fn gbuffer(&self, name: &str) -> Result<GBuffer, Error> {
        match self.required(name)? {
            Value::GBuffer(buffer) => Ok(buffer.clone()),
            _ => Err(self.wrong_kind(name)),
        }
    }

    /// Returns whether an input has a value in this frame.
    pub fn is_connected(&self, name: &str) -> bool {
        self.value(name).is_ok_and(|value| value.is_some())
    }

    /// Returns whether a node or an output of the pipeline reads an output, for a node that computes an optional output on demand.
    pub fn is_read(&self, output: &str) -> bool {
        let found = self.outputs.iter().find(|(port, _)| port.name == output);
        found.is_some_and(|(_, index)| self.is_read.get(*index).is_some_and(|read| *read))
    }

    /// Creates the texture of an output, named like the output. If the output is the view's image, this is the view's target, and
    /// `desc` is ignored.
    pub fn create(&self, output: &str, frame: &mut Frame<'f>, desc: TextureDesc) -> Texture {
        if self.image == Some(output) {
            return self.view.target_texture(frame);
        }
        frame.create_texture(output, desc)
    }

    /// Sets the value of an output. An output that the node does not declare is ignored.
    pub fn set(&mut self, output: &str, value: impl Into<Value<'f>>) {
        let index = self.outputs.iter().find(|(port, _)| port.name == output).map(|(_, index)| *index);
        if let Some(slot) = index.and_then(|index| self.values.get_mut(index)) {
            *slot = Some(value.into());
        }
    }
}
