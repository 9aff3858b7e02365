//! A node's ports in one frame.

use shadowgraph_core::{Buffer, Contents, Format, Frame, Texture, TextureDesc};
use shadowgraph_lighting::{GBuffer, ViewBuffers};
use shadowgraph_shadows::{ShadowOutputs, SurfaceBuffers};

use super::port::{Need, Port, Value};
use crate::Error;
use crate::pipelines::View;

/// What a node finds at its inputs, and leaves at its outputs.
pub struct Ports<'n, 'f> {
    pub(crate) kind: &'static str,
    pub(crate) node: &'n str,
    pub(crate) view: &'f View<'f>,
    /// With the places of values that feed them.
    pub(crate) inputs: &'n [(Port, Option<usize>)],
    /// With the places of their values.
    pub(crate) outputs: &'n [(Port, usize)],
    pub(crate) values: &'n mut [Option<Value<'f>>],
    /// The output that the picture comes from, if it is one of these.
    pub(crate) picture: Option<&'n str>,
}

impl<'f> Ports<'_, 'f> {
    fn value(&self, name: &str) -> Result<Option<&Value<'f>>, Error> {
        let (_, place) = self.inputs.iter().find(|(port, _)| port.name == name).ok_or_else(|| {
            let fault = format!("it reads an input `{name}` that it does not describe");
            Error::NodeKind { kind: self.kind, fault }
        })?;
        Ok(place.and_then(|place| self.values.get(place)?.as_ref()))
    }

    fn required(&self, name: &str) -> Result<&Value<'f>, Error> {
        self.value(name)?.ok_or_else(|| Error::Unfed { node: self.node.into(), port: name.into() })
    }

    fn wrong(&self, name: &str) -> Error {
        let fault = format!("it reads its input `{name}` as another kind of port than it describes");
        Error::NodeKind { kind: self.kind, fault }
    }

    /// Returns the texture at an input.
    ///
    /// # Errors
    /// [`Error::Unfed`] where the frame has none; [`Error::NodeKind`] for an input that the node does not describe so. So for
    /// all of these.
    pub fn texture(&self, name: &str) -> Result<Texture, Error> {
        match self.required(name)? {
            Value::Texture(texture) => Ok(texture.clone()),
            _ => Err(self.wrong(name)),
        }
    }

    /// Returns the texture at an input, or its stand-in, or one of a black texel.
    ///
    /// # Errors
    /// As [`texture`](Self::texture), but for what is not fed.
    pub fn texture_or_stand_in(&self, name: &str, frame: &mut Frame<'f>) -> Result<Texture, Error> {
        if self.value(name)?.is_some() {
            return self.texture(name);
        }
        let need = self.inputs.iter().find(|(port, _)| port.name == name).map(|(port, _)| port.need);
        let color = match need {
            Some(Need::StandIn(color)) => color,
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
            _ => Err(self.wrong(name)),
        }
    }

    /// Returns the camera and the lights at an input.
    ///
    /// # Errors
    /// As [`texture`](Self::texture).
    pub fn view(&self, name: &str) -> Result<ViewBuffers, Error> {
        match self.required(name)? {
            Value::View(view) => Ok(view.clone()),
            _ => Err(self.wrong(name)),
        }
    }

    /// Returns the surfaces at an input; `None` where the frame has none.
    ///
    /// # Errors
    /// As [`texture`](Self::texture), but for what is not fed.
    pub fn surfaces(&self, name: &str) -> Result<Option<SurfaceBuffers>, Error> {
        match self.value(name)? {
            None => Ok(None),
            Some(Value::Surfaces(screen)) => Ok(Some(screen.clone())),
            Some(_) => Err(self.wrong(name)),
        }
    }

    /// Returns the shadows at an input.
    ///
    /// # Errors
    /// As [`texture`](Self::texture).
    pub fn shadows(&self, name: &str) -> Result<&ShadowOutputs<'f>, Error> {
        match self.required(name)? {
            Value::Shadows(shadows) => Ok(shadows),
            _ => Err(self.wrong(name)),
        }
    }

    /// Returns the G-buffer at an input.
    ///
    /// # Errors
    /// As [`texture`](Self::texture).
    pub fn gbuffer(&self, name: &str) -> Result<GBuffer, Error> {
        match self.required(name)? {
            Value::GBuffer(buffer) => Ok(buffer.clone()),
            _ => Err(self.wrong(name)),
        }
    }

    /// Whether something feeds an input in this frame.
    pub fn has(&self, name: &str) -> bool {
        self.value(name).is_ok_and(|value| value.is_some())
    }

    /// Creates the texture for an output, called as the output is. Where the picture comes from this output it is the view's own
    /// target, and `desc` is not looked at.
    pub fn create(&self, output: &str, frame: &mut Frame<'f>, desc: TextureDesc) -> Texture {
        if self.picture == Some(output) {
            return self.view.picture(frame);
        }
        frame.create_texture(output, desc)
    }

    /// Leaves something at an output.
    pub fn set(&mut self, output: &str, value: impl Into<Value<'f>>) {
        // An output that is not described leads nowhere; the file's check tells of those that stay empty.
        let place = self.outputs.iter().find(|(port, _)| port.name == output).map(|(_, place)| *place);
        if let Some(slot) = place.and_then(|place| self.values.get_mut(place)) {
            *slot = Some(value.into());
        }
    }
}
