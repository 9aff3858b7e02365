//! The trait of nodes.

use shadowgraph_core::Frame;

use super::port::Port;
use super::ports::Ports;
use super::setting::{Setting, Settings};
use crate::build_context::BuildContext;
use crate::error::Error;
use crate::render_view::RenderView;

/// A kind of node; a value is one node, with what it keeps from frame to frame.
///
/// ```
/// use shadowgraph::core::{Format, Frame, FullscreenShader, TextureDesc};
/// use shadowgraph::nodes::{Node, Nodes, Port, Ports, Setting, SettingType, Settings};
/// use shadowgraph::{BuildContext, Error, RenderView};
///
/// struct Vignette {
///     shader: FullscreenShader,
///     strength: f32,
/// }
///
/// impl Node for Vignette {
///     const NAME: &'static str = "vignette";
///     const ABOUT: &'static str = "darkens the corners of the image";
///     const INPUTS: &'static [Port] = &[Port::texture("light", "the lit scene")];
///     const OUTPUTS: &'static [Port] = &[Port::texture("light", "the same, darker in the corners")];
///     const SETTINGS: &'static [Setting] =
///         &[Setting::new("strength", SettingType::Number(0.5, 0.0, 1.0), "how dark the corners are")];
///
///     fn new(_context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
///         let shader = FullscreenShader::wgsl("vignette", "
///             @group(0) @binding(0) var light: texture_2d<f32>;
///             @group(0) @binding(1) var<uniform> strength: f32;
///             @fragment fn vignette(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
///                 let from_center = length(uv * 2.0 - 1.0);
///                 return textureLoad(light, vec2u(position.xy), 0) * (1.0 - strength * smoothstep(0.5, 1.4, from_center));
///             }");
///         Ok(Self { shader, strength: settings.number("strength")? })
///     }
///
///     fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f RenderView<'f>, ports: &mut Ports<'_, 'f>) -> Result<(), Error> {
///         let mut darker = ports.create("light", frame, view.texture_desc(Format::Rgba16Float));
///         let light = ports.texture("light")?;
///         frame.fullscreen("vignette", &self.shader).sample(&light).uniform(&self.strength.to_le_bytes()).draw(&mut darker);
///         ports.set("light", darker);
///         Ok(())
///     }
/// }
///
/// let mut nodes = Nodes::built_in();
/// nodes.register::<Vignette>()?;
/// assert!(nodes.describe("vignette")?.contains("0 to 1"));
/// # Ok::<(), Error>(())
/// ```
pub trait Node: Send + Sync + Sized + 'static {
    /// The name of the kind in pipelines.
    const NAME: &'static str;
    /// Describes the node in a phrase.
    const ABOUT: &'static str;
    /// The inputs.
    const INPUTS: &'static [Port];
    /// The outputs.
    const OUTPUTS: &'static [Port];
    /// The settings.
    const SETTINGS: &'static [Setting] = &[];
    /// Whether it groups its passes in graph nodes itself, so that none is put around them.
    const GROUPS_ITSELF: bool = false;
    /// Whether it averages frames, as temporal anti-aliasing does: then noise changes from frame to frame.
    const TEMPORAL: bool = false;

    /// Creates what the node keeps from frame to frame.
    ///
    /// # Errors
    /// For shaders that do not compose.
    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error>;

    /// Adds the passes to a frame: reads the inputs from `ports` and sets the outputs there.
    ///
    /// # Errors
    /// For a view that the node cannot draw.
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error>;
}

/// A node of any kind.
pub(crate) trait AnyNode: Send + Sync {
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error>;
}

impl<N: Node> AnyNode for N {
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        Node::add(self, frame, view, ports)
    }
}
