//! Nodes that pipelines are composed of, by name.
//!
//! A kind of node is one `impl` of [`Node`]: what it is called, what it takes and gives, what of it can be chosen, and the passes
//! that it adds to a frame. [`Nodes`] knows kinds by name, those of other crates too; pipeline files name them.

mod built_in;
mod port;
mod ports;
mod setting;

pub use built_in::Geometry as GeometryNode;
pub(crate) use built_in::{Shadows as ShadowsNode, Taa as TaaNode, ViewUniforms as ViewNode};
pub use port::{Need, Port, PortKind, Value};
pub use ports::Ports;
pub use setting::{Setting, SettingType, Settings};

use serde_json::json;
use shadowgraph_core::Frame;

use crate::Error;
use crate::pipelines::{Build, View};

/// A kind of node, and what one of them keeps from frame to frame.
///
/// ```
/// use shadowgraph::core::{Format, Frame, FullscreenShader, TextureDesc};
/// use shadowgraph::nodes::{SettingType, Node, Nodes, Port, Ports, Setting, Settings};
/// use shadowgraph::pipelines::{Build, View};
/// use shadowgraph::Error;
///
/// struct Vignette {
///     shader: FullscreenShader,
///     strength: f32,
/// }
///
/// impl Node for Vignette {
///     const NAME: &'static str = "vignette";
///     const ABOUT: &'static str = "darkens the corners of the picture";
///     const INPUTS: &'static [Port] = &[Port::texture("light", "what is lit")];
///     const OUTPUTS: &'static [Port] = &[Port::texture("light", "the same, darker in the corners")];
///     const SETTINGS: &'static [Setting] =
///         &[Setting::new("strength", SettingType::Number(0.5, 0.0, 1.0), "how dark corners are")];
///
///     fn new(_build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
///         let shader = FullscreenShader::wgsl("vignette", "
///             @group(0) @binding(0) var light: texture_2d<f32>;
///             @group(0) @binding(1) var<uniform> strength: f32;
///             @fragment fn vignette(@builtin(position) at: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
///                 let from_middle = length(uv * 2.0 - 1.0);
///                 return textureLoad(light, vec2u(at.xy), 0) * (1.0 - strength * smoothstep(0.5, 1.4, from_middle));
///             }");
///         Ok(Self { shader, strength: settings.number("strength")? })
///     }
///
///     fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>, ports: &mut Ports<'_, 'f>) -> Result<(), Error> {
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
    /// What pipelines call it.
    const NAME: &'static str;
    /// What it does, in a phrase.
    const ABOUT: &'static str;
    /// What it takes.
    const INPUTS: &'static [Port];
    /// What it gives.
    const OUTPUTS: &'static [Port];
    /// What of it can be chosen.
    const SETTINGS: &'static [Setting] = &[];
    /// Whether its passes stand in nodes of their own already, so that none is put around them.
    const GROUPS_ITSELF: bool = false;

    /// Makes what stays from frame to frame.
    ///
    /// # Errors
    /// For shaders that do not compose.
    fn new(build: &Build<'_>, settings: &Settings) -> Result<Self, Error>;

    /// Adds its passes to a frame: reads its inputs from `ports`, and sets its outputs there.
    ///
    /// # Errors
    /// For what a view asks for and cannot be.
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error>;
}

/// A node whose kind is not known.
pub(crate) trait AnyNode: Send + Sync {
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error>;
}

impl<N: Node> AnyNode for N {
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        Node::add(self, frame, view, ports)
    }
}

type Make = fn(&Build<'_>, &Settings) -> Result<Box<dyn AnyNode>, Error>;

/// What is known of a kind of node.
#[derive(Clone, Copy, Debug)]
pub struct NodeKind {
    /// What pipelines call it.
    pub name: &'static str,
    /// What it does.
    pub about: &'static str,
    /// What it takes.
    pub inputs: &'static [Port],
    /// What it gives.
    pub outputs: &'static [Port],
    /// What of it can be chosen.
    pub settings: &'static [Setting],
    pub(crate) groups_itself: bool,
    pub(crate) make: Make,
}

impl NodeKind {
    fn of<N: Node>() -> Self {
        Self {
            name: N::NAME,
            about: N::ABOUT,
            inputs: N::INPUTS,
            outputs: N::OUTPUTS,
            settings: N::SETTINGS,
            groups_itself: N::GROUPS_ITSELF,
            make: |build, settings| Ok(Box::new(N::new(build, settings)?)),
        }
    }

    /// Returns the JSON Schema of a node of this kind as a pipeline file has it.
    pub fn schema(&self) -> serde_json::Value {
        let inputs = self.inputs.iter().map(|port| {
            let description = format!("{}: {}", port.kind.name(), port.about);
            let fed = json!({ "type": "string" });
            let schema = json!({
                "description": description,
                "anyOf": [fed, { "type": "array", "items": fed }],
            });
            (port.name.to_owned(), schema)
        });
        let required = |port: &&Port| port.need == Need::Required;
        let required: Vec<&str> = self.inputs.iter().filter(required).map(|port| port.name).collect();
        let settings = self.settings.iter().map(|setting| (setting.name.to_owned(), setting.schema()));
        json!({
            "description": self.about,
            "type": "object",
            "properties": {
                "name": { "type": "string" },
                "kind": { "const": self.name },
                "inputs": {
                    "type": "object",
                    "properties": inputs.collect::<serde_json::Map<_, _>>(),
                    "required": required,
                    "additionalProperties": false,
                },
                "settings": {
                    "type": "object",
                    "properties": settings.collect::<serde_json::Map<_, _>>(),
                    "additionalProperties": false,
                },
                "when": {},
            },
            "required": ["name", "kind"],
            "additionalProperties": false,
        })
    }
}

/// Kinds of nodes by name.
#[derive(Clone, Debug)]
pub struct Nodes(Vec<NodeKind>);

impl Nodes {
    /// Returns those that Shadowgraph comes with.
    pub fn built_in() -> Self {
        Self(built_in::kinds().to_vec())
    }

    /// Adds a kind.
    ///
    /// # Errors
    /// [`Error::NodeKind`] for a name that is known already, and for ports and settings that contradict each other.
    pub fn register<N: Node>(&mut self) -> Result<(), Error> {
        let kind = NodeKind::of::<N>();
        self.fault(&kind).map_or(Ok(()), |fault| Err(Error::NodeKind { kind: kind.name, fault }))?;
        self.0.push(kind);
        Ok(())
    }

    fn fault(&self, kind: &NodeKind) -> Option<String> {
        if self.get(kind.name).is_some() {
            return Some("there is a kind of that name already".into());
        }
        let names = |names: Vec<&'static str>, what: &str| {
            let twice = names.iter().enumerate().find(|(at, name)| names[..*at].contains(name));
            twice.map(|(_, name)| format!("it has two {what} `{name}`"))
        };
        let ports = |ports: &[Port]| ports.iter().map(|port| port.name).collect();
        let wrong_default = kind.settings.iter().find_map(|setting| setting.fault(&setting.default_value()));
        let stand_in = |port: &&Port| matches!(port.need, Need::StandIn(_)) && port.kind != PortKind::Texture;
        names(ports(kind.inputs), "inputs")
            .or_else(|| names(ports(kind.outputs), "outputs"))
            .or_else(|| names(kind.settings.iter().map(|setting| setting.name).collect(), "settings"))
            .or_else(|| wrong_default.map(|fault| format!("a default is out of its range: {fault}")))
            .or_else(|| {
                let port = kind.inputs.iter().find(stand_in)?;
                Some(format!("only textures have stand-ins, and `{}` is a {}", port.name, port.kind.name()))
            })
    }

    /// Returns the kinds in order of registration.
    pub fn kinds(&self) -> &[NodeKind] {
        &self.0
    }

    /// Returns the kind of a name.
    pub fn get(&self, name: &str) -> Option<&NodeKind> {
        self.0.iter().find(|kind| kind.name == name)
    }

    /// Tells all about a kind: its ports and settings, with ranges, units and defaults.
    ///
    /// # Errors
    /// [`Error::NoNodeKind`] with a name that is like it.
    pub fn describe(&self, name: &str) -> Result<String, Error> {
        use std::fmt::Write as _;
        let kind = self.get(name).ok_or_else(|| Error::NoNodeKind {
            name: name.into(),
            hint: near_words(name, self.0.iter().map(|kind| kind.name)),
        })?;
        let mut out = format!("{}: {}\n", kind.name, kind.about);
        for (title, ports) in [("takes", kind.inputs), ("gives", kind.outputs)] {
            for port in ports {
                let format = port.format.map_or(String::new(), |format| format!(" {format:?}"));
                let need = match port.need {
                    Need::Required => String::new(),
                    Need::Optional => ", optional".into(),
                    Need::StandIn([red, green, blue, alpha]) => {
                        format!(", ({red:?}, {green:?}, {blue:?}, {alpha:?}) where it is not fed")
                    }
                };
                let _ = writeln!(
                    out,
                    "  {title}  {:<18} {}{format}: {}{need}",
                    port.name,
                    port.kind.name(),
                    port.about
                );
            }
        }
        for setting in kind.settings {
            let allowed = setting.allowed();
            let default = match setting.ty {
                SettingType::Color([red, green, blue]) => format!("({red:?}, {green:?}, {blue:?})"),
                _ => setting.default_value().to_string(),
            };
            let _ = writeln!(out, "  set    {:<18} {default}; {allowed}: {}", setting.name, setting.about);
        }
        Ok(out)
    }
}

/// `; did you mean ...?`, or which there are.
pub(crate) fn near_words<'n>(wanted: &str, known: impl Iterator<Item = &'n str>) -> String {
    let known: Vec<&str> = known.collect();
    let wanted = wanted.to_lowercase();
    let alike = |name: &str| match name.to_lowercase() {
        // One slip in a short name weighs too much otherwise.
        name if name.len() > 2 && strsim::osa_distance(&name, &wanted) == 1 => 0.95,
        name => strsim::jaro_winkler(&name, &wanted),
    };
    let rated = known.iter().map(|name| (alike(name), *name));
    let nearest = rated.filter(|(alike, _)| *alike > 0.75).max_by(|a, b| a.0.total_cmp(&b.0));
    match nearest {
        Some((_, name)) => format!("; did you mean `{name}`?"),
        None if known.is_empty() => "; there is none".into(),
        None => format!("; there is: {}", known.join(", ")),
    }
}

#[cfg(test)]
mod tests;
