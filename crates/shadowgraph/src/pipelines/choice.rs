//! Pipelines by name, by file, and of one's own.

use std::fmt;
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

use shadowgraph_shadows::{Technique, Techniques};

use super::{
    Build, Choices, DebugCascades, Deferred, Forward, ForwardPlus, Minimal, PipelineError, PipelineFile,
    Wiring,
};
use crate::Error;
use crate::nodes::Nodes;
use crate::options::OptionError;

/// The files of the built-in pipelines, the default first.
const FILES: &[(&str, &str)] = &[
    ("forward", include_str!("../../pipelines/forward.ron")),
    ("forward_plus", include_str!("../../pipelines/forward_plus.ron")),
    ("deferred", include_str!("../../pipelines/deferred.ron")),
    ("screen_shadows", include_str!("../../pipelines/screen_shadows.ron")),
    ("minimal", include_str!("../../pipelines/minimal.ron")),
    ("debug_cascades", include_str!("../../pipelines/debug_cascades.ron")),
];

/// The names of the built-in pipelines, the default first.
pub const BUILT_IN: &[&str] =
    &["forward", "forward_plus", "deferred", "screen_shadows", "minimal", "debug_cascades"];

type Make = dyn Fn(&Build<'_>) -> Result<Box<dyn Wiring>, Error> + Send + Sync;

/// A way of putting a frame together: a built-in one, one of a file, or a script.
///
/// ```
/// use shadowgraph::pipelines::{Forward, Pipeline};
/// let of_a_file: Pipeline = "forward".parse()?;
/// let of_a_script = Pipeline::script("forward in Rust", |build| Ok(Box::new(Forward::new(build)?)));
/// assert_eq!(of_a_file.name(), "forward");
/// let error = "forwards".parse::<Pipeline>().unwrap_err().to_string();
/// assert!(error.ends_with("did you mean `forward`?"), "{error}");
/// # Ok::<(), shadowgraph::options::OptionError>(())
/// ```
#[derive(Clone)]
pub struct Pipeline(Arc<Kind>);

enum Kind {
    File { file: Box<PipelineFile>, built_in: bool },
    Script { name: String, make: Box<Make>, collected: bool },
}

impl Pipeline {
    /// Returns a pipeline that a script wires; `make` makes what it keeps from frame to frame.
    pub fn script(
        name: &str,
        make: impl Fn(&Build<'_>) -> Result<Box<dyn Wiring>, Error> + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(Kind::Script { name: name.to_owned(), make: Box::new(make), collected: false }))
    }

    /// Is like [`script`](Self::script), with shadows that are collected in a screen mask.
    pub fn script_with_collected_shadows(
        name: &str,
        make: impl Fn(&Build<'_>) -> Result<Box<dyn Wiring>, Error> + Send + Sync + 'static,
    ) -> Self {
        Self(Arc::new(Kind::Script { name: name.to_owned(), make: Box::new(make), collected: true }))
    }

    /// Reads a pipeline file, and checks it against these nodes and techniques.
    ///
    /// # Errors
    /// For what cannot be read and what is wrong in it: the file, the line and the column, and the way out.
    pub fn load(
        file: &Path,
        nodes: &Nodes,
        techniques: &Techniques,
        choices: &Choices,
    ) -> Result<Self, PipelineError> {
        let file = Box::new(PipelineFile::load(file, nodes, techniques, choices)?);
        Ok(Self(Arc::new(Kind::File { file, built_in: false })))
    }

    /// Returns a built-in pipeline.
    ///
    /// # Errors
    /// For a name that there is not, and choices that it does not have.
    pub fn built_in(name: &str, choices: &Choices) -> Result<Self, PipelineError> {
        let Some((name, text)) = FILES.iter().find(|(known, _)| *known == name) else {
            return Err(PipelineError::unknown(name, BUILT_IN));
        };
        let file = Box::new(PipelineFile::of_text(name, text, choices)?);
        Ok(Self(Arc::new(Kind::File { file, built_in: true })))
    }

    /// Returns the text of a built-in pipeline's file, to begin one of your own with.
    pub fn text_of(name: &str) -> Option<&'static str> {
        FILES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
    }

    /// Returns the built-in pipeline that is taken where nothing is said: a depth prepass, then each pixel is lit once and asks
    /// for its shadows.
    pub fn forward() -> Self {
        Self::known("forward")
    }

    /// Returns the built-in pipeline in which each pixel asks only the lights that reach its part of the view.
    pub fn forward_plus() -> Self {
        Self::known("forward_plus")
    }

    /// Returns the built-in pipeline that draws a G-buffer and lights each pixel once.
    pub fn deferred() -> Self {
        Self::known("deferred")
    }

    /// Returns the built-in pipeline that collects shadows in a screen mask before anything is lit.
    pub fn screen_shadows() -> Self {
        Self::known("screen_shadows")
    }

    /// Returns the built-in pipeline without a depth prepass.
    pub fn minimal() -> Self {
        Self::known("minimal")
    }

    fn known(name: &'static str) -> Self {
        // Tests read each of the files. Should one be wrong all the same, the error comes when the pipeline is made.
        Self::built_in(name, &Choices::default())
            .unwrap_or_else(|error| Self::script(name, move |_| Err(Error::Pipeline(error.clone()))))
    }

    /// Returns the twins of the built-in pipelines in Rust, by the same names.
    pub fn scripts() -> Vec<Self> {
        let forward =
            |build: &Build<'_>| -> Result<Box<dyn Wiring>, Error> { Ok(Box::new(Forward::new(build)?)) };
        vec![
            Self::script("forward", forward),
            Self::script("forward_plus", |build| Ok(Box::new(ForwardPlus::new(build)?))),
            Self::script("deferred", |build| Ok(Box::new(Deferred::new(build)?))),
            Self::script_with_collected_shadows("screen_shadows", forward),
            Self::script("minimal", |build| Ok(Box::new(Minimal::new(build)?))),
            Self::script("debug_cascades", |build| Ok(Box::new(DebugCascades::new(build)?))),
        ]
    }

    /// Returns what it is called: a built-in pipeline's name, the file, or what its script was called.
    pub fn name(&self) -> &str {
        match &*self.0 {
            Kind::File { file, .. } => &file.name,
            Kind::Script { name, .. } => name,
        }
    }

    /// Returns what its file says of it.
    pub fn about(&self) -> &str {
        match &*self.0 {
            Kind::File { file, .. } => file.about(),
            Kind::Script { .. } => "",
        }
    }

    /// Tells what is right in its file and yet not as one may expect, a line each: nodes that lead to no output, parameters that
    /// nothing asks for, and temporal anti-aliasing without a camera that jitters or the other way round.
    pub fn warnings(&self) -> Vec<PipelineError> {
        match &*self.0 {
            Kind::File { file, .. } => file.warnings(),
            Kind::Script { .. } => Vec::new(),
        }
    }

    /// Returns whether its file has a node of this name whose `when` does not hold.
    pub(crate) fn leaves_out(&self, node: &str) -> bool {
        match &*self.0 {
            Kind::File { file, .. } => file.left_out().any(|name| name == node),
            Kind::Script { .. } => false,
        }
    }

    /// Returns the technique that its file names.
    pub fn technique(&self) -> Option<Technique> {
        match &*self.0 {
            Kind::File { file, .. } => file.technique,
            Kind::Script { .. } => None,
        }
    }

    /// Returns whether shadows are collected in a screen mask.
    pub fn collects_shadows(&self) -> bool {
        match &*self.0 {
            Kind::File { file, .. } => file.collected,
            Kind::Script { collected, .. } => *collected,
        }
    }

    /// Returns it with the tier that its file has for a kind of device, where no tier was chosen.
    ///
    /// # Errors
    /// None that its file can cause: all tiers are checked as it is read.
    pub(crate) fn on(&self, device: wgpu::DeviceType) -> Result<Self, PipelineError> {
        let device = match device {
            wgpu::DeviceType::Cpu => "cpu",
            wgpu::DeviceType::IntegratedGpu => "integrated",
            wgpu::DeviceType::DiscreteGpu => "discrete",
            wgpu::DeviceType::VirtualGpu => "virtual",
            wgpu::DeviceType::Other => "other",
        };
        Ok(match &*self.0 {
            Kind::File { file, built_in } => {
                Self(Arc::new(Kind::File { file: Box::new(file.on(device)?), built_in: *built_in }))
            }
            Kind::Script { .. } => self.clone(),
        })
    }

    /// Makes what it keeps from frame to frame.
    ///
    /// # Errors
    /// For shaders that do not compose.
    pub(crate) fn make(&self, build: &Build<'_>) -> Result<Box<dyn Wiring>, Error> {
        match &*self.0 {
            Kind::File { file, .. } => file.make(build),
            Kind::Script { make, .. } => make(build),
        }
    }
}

impl Default for Pipeline {
    fn default() -> Self {
        Self::forward()
    }
}

impl fmt::Debug for Pipeline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Pipeline").field(&self.name()).finish()
    }
}

/// Built-in pipelines are the same by name and choices, others if one was cloned from the other.
impl PartialEq for Pipeline {
    fn eq(&self, other: &Self) -> bool {
        let same = match (&*self.0, &*other.0) {
            (Kind::File { file: a, built_in: true }, Kind::File { file: b, built_in: true }) => a.is(b),
            _ => false,
        };
        same || Arc::ptr_eq(&self.0, &other.0)
    }
}

impl FromStr for Pipeline {
    type Err = OptionError;

    fn from_str(name: &str) -> Result<Self, OptionError> {
        Self::built_in(name, &Choices::default())
            .map_err(|error| OptionError::new("--pipeline", error.problem))
    }
}
