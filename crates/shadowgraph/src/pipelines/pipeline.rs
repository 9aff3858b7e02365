//! Pipelines by name, from a file, or as a script.

use std::fmt;
use std::path::Path;
use std::str::FromStr;
use std::sync::Arc;

use shadowgraph_core::did_you_mean;
use shadowgraph_shadows::{Technique, Techniques};

use super::file::PipelineFile;
use super::file::parameters::Parameters;
use super::instance::PipelineInstance;
use crate::build_context::BuildContext;
use crate::error::{Error, PipelineError};
use crate::nodes::registry::Nodes;
use crate::options::error::OptionError;

/// Names and files of the built-in pipelines, the default first.
const FILES: &[(&str, &str)] = &[
    ("forward", include_str!("../../pipelines/forward.ron")),
    ("minimal_lit", include_str!("../../pipelines/minimal_lit.ron")),
    ("forward_plus", include_str!("../../pipelines/forward_plus.ron")),
    ("deferred", include_str!("../../pipelines/deferred.ron")),
    ("screen_shadows", include_str!("../../pipelines/screen_shadows.ron")),
    ("minimal", include_str!("../../pipelines/minimal.ron")),
    ("debug_cascades", include_str!("../../pipelines/debug_cascades.ron")),
];

/// The names of the built-in pipelines, the default first.
pub const BUILT_IN: &[&str] =
    &["forward", "minimal_lit", "forward_plus", "deferred", "screen_shadows", "minimal", "debug_cascades"];

type BuildFn = dyn Fn(&BuildContext<'_>) -> Result<Box<dyn PipelineInstance>, Error> + Send + Sync;

/// A way to compose a frame: a built-in pipeline, a pipeline file, or a script.
///
/// ```
/// use shadowgraph::pipelines::Pipeline;
/// let pipeline: Pipeline = "forward".parse()?;
/// assert_eq!(pipeline.name(), "forward");
/// let error = "forwards".parse::<Pipeline>().unwrap_err().to_string();
/// assert!(error.ends_with("did you mean `forward`?"), "{error}");
/// # Ok::<(), shadowgraph::options::OptionError>(())
/// ```
#[derive(Clone)]
pub struct Pipeline(Arc<Source>);

enum Source {
    File { file: Box<PipelineFile>, built_in: bool },
    Script { name: String, build: Box<BuildFn>, screen_shadows: bool },
}

/// Where a pipeline is from.
pub(crate) enum PipelineSource<'p> {
    BuiltIn { name: &'p str, parameters: &'p Parameters },
    File { name: &'p str, text: &'p str, parameters: &'p Parameters },
    Script,
}

impl Pipeline {
    /// Creates a pipeline from a script; `build` creates what it keeps from frame to frame.
    pub fn script(
        name: &str,
        build: impl Fn(&BuildContext<'_>) -> Result<Box<dyn PipelineInstance>, Error> + Send + Sync + 'static,
    ) -> Self {
        let (name, build) = (name.to_owned(), Box::new(build));
        Self(Arc::new(Source::Script { name, build, screen_shadows: false }))
    }

    /// Creates a pipeline from a script like [`script`](Self::script), with screen-space shadows.
    pub fn script_with_screen_shadows(
        name: &str,
        build: impl Fn(&BuildContext<'_>) -> Result<Box<dyn PipelineInstance>, Error> + Send + Sync + 'static,
    ) -> Self {
        let (name, build) = (name.to_owned(), Box::new(build));
        Self(Arc::new(Source::Script { name, build, screen_shadows: true }))
    }

    /// Reads a pipeline file and checks it against the nodes and techniques.
    ///
    /// # Errors
    /// For a file that cannot be read or is invalid: the file, line and column, and what is expected.
    pub fn load(
        file: &Path,
        nodes: &Nodes,
        techniques: &Techniques,
        parameters: &Parameters,
    ) -> Result<Self, PipelineError> {
        let file = Box::new(PipelineFile::load(file, nodes, techniques, parameters)?);
        Ok(Self(Arc::new(Source::File { file, built_in: false })))
    }

    /// Returns a built-in pipeline.
    ///
    /// # Errors
    /// For an unknown name, and for parameters that the pipeline does not have.
    pub fn built_in(name: &str, parameters: &Parameters) -> Result<Self, PipelineError> {
        let Some((name, text)) = find_built_in(name) else {
            let hint = did_you_mean(name, BUILT_IN.iter().copied());
            let problem = format!("unknown pipeline `{name}`{hint}");
            return Err(PipelineError { location: name.into(), problem });
        };
        let file = Box::new(PipelineFile::parse(name, text, parameters)?);
        Ok(Self(Arc::new(Source::File { file, built_in: true })))
    }

    /// Reads the text of a pipeline file like [`load`](Self::load). Errors name `file`.
    ///
    /// # Errors
    /// As `load`.
    pub fn from_text(
        file: &str,
        text: &str,
        nodes: &Nodes,
        techniques: &Techniques,
        parameters: &Parameters,
    ) -> Result<Self, PipelineError> {
        let file = Box::new(PipelineFile::read(file, text, nodes, techniques, parameters)?);
        Ok(Self(Arc::new(Source::File { file, built_in: false })))
    }

    /// Returns where the pipeline is from.
    pub(crate) fn source(&self) -> PipelineSource<'_> {
        match &*self.0 {
            Source::File { file, built_in: true } => {
                PipelineSource::BuiltIn { name: &file.name, parameters: &file.parameters }
            }
            Source::File { file, .. } => {
                PipelineSource::File { name: &file.name, text: file.text(), parameters: &file.parameters }
            }
            Source::Script { .. } => PipelineSource::Script,
        }
    }

    /// Returns the text of a built-in pipeline's file, a start for your own.
    pub fn built_in_text(name: &str) -> Option<&'static str> {
        find_built_in(name).map(|(_, text)| text)
    }

    /// Returns the default pipeline: a sky, ambient occlusion, one lit pass that looks shadows up per pixel, automatic exposure and
    /// smooth edges.
    pub fn forward() -> Self {
        Self::known("forward")
    }

    /// Returns the built-in pipeline of a depth prepass, shadows, one lit pass and tonemapping, for measurements.
    pub fn minimal_lit() -> Self {
        Self::known("minimal_lit")
    }

    /// Returns the built-in pipeline with clustered lights: each pixel visits only the lights that reach its cluster.
    pub fn forward_plus() -> Self {
        Self::known("forward_plus")
    }

    /// Returns the built-in pipeline that draws a G-buffer and lights each pixel once.
    pub fn deferred() -> Self {
        Self::known("deferred")
    }

    /// Returns the built-in pipeline that computes shadows in a screen-space mask before anything is lit.
    pub fn screen_shadows() -> Self {
        Self::known("screen_shadows")
    }

    /// Returns the built-in pipeline without a depth prepass.
    pub fn minimal() -> Self {
        Self::known("minimal")
    }

    fn known(name: &'static str) -> Self {
        // Tests read each of the files. If one is invalid all the same, the error is reported when the pipeline is built.
        Self::built_in(name, &Parameters::default())
            .unwrap_or_else(|error| Self::script(name, move |_| Err(Error::Pipeline(error.clone()))))
    }

    /// Returns the name: of a built-in pipeline, of the file, or of the script.
    pub fn name(&self) -> &str {
        match &*self.0 {
            Source::File { file, .. } => &file.name,
            Source::Script { name, .. } => name,
        }
    }

    /// Returns the description in the file.
    pub fn about(&self) -> &str {
        match &*self.0 {
            Source::File { file, .. } => file.about(),
            Source::Script { .. } => "",
        }
    }

    /// Returns warnings about the file, a line each: nodes that no output depends on, unused parameters, and temporal
    /// anti-aliasing without a jittered camera or the other way round.
    pub fn warnings(&self) -> Vec<PipelineError> {
        match &*self.0 {
            Source::File { file, .. } => file.warnings(),
            Source::Script { .. } => Vec::new(),
        }
    }

    /// Returns whether the file has a node of this name whose `when` does not hold.
    pub fn is_disabled(&self, node: &str) -> bool {
        match &*self.0 {
            Source::File { file, .. } => file.disabled_nodes().any(|name| name == node),
            Source::Script { .. } => false,
        }
    }

    /// Returns the technique that the file names.
    pub fn technique(&self) -> Option<Technique> {
        match &*self.0 {
            Source::File { file, .. } => file.technique,
            Source::Script { .. } => None,
        }
    }

    /// Returns whether shadows are computed in a screen-space mask.
    pub fn has_screen_shadows(&self) -> bool {
        match &*self.0 {
            Source::File { file, .. } => file.screen_shadows,
            Source::Script { screen_shadows, .. } => *screen_shadows,
        }
    }

    /// Returns whether the pipeline draws the sky and the ground as background; scripts may.
    pub fn has_sky(&self) -> bool {
        match &*self.0 {
            Source::File { file, .. } => file.has_sky,
            Source::Script { .. } => true,
        }
    }

    /// Builds the pipeline for a device.
    ///
    /// # Errors
    /// For shaders that do not compose, and for nodes that do not support the target.
    pub fn build(&self, context: &BuildContext<'_>) -> Result<Box<dyn PipelineInstance>, Error> {
        match &*self.0 {
            Source::File { file, .. } => file.build(context),
            Source::Script { build, .. } => build(context),
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

/// Compares built-in pipelines by name and parameters; others are equal if one is a clone of the other.
impl PartialEq for Pipeline {
    fn eq(&self, other: &Self) -> bool {
        let same = match (&*self.0, &*other.0) {
            (Source::File { file: a, built_in: true }, Source::File { file: b, built_in: true }) => {
                a.has_same_source(b)
            }
            _ => false,
        };
        same || Arc::ptr_eq(&self.0, &other.0)
    }
}

impl FromStr for Pipeline {
    type Err = OptionError;

    fn from_str(name: &str) -> Result<Self, OptionError> {
        Self::built_in(name, &Parameters::default())
            .map_err(|error| OptionError::new("pipeline", error.problem))
    }
}

/// Returns the name and the text of a built-in pipeline.
fn find_built_in(name: &str) -> Option<(&'static str, &'static str)> {
    FILES.iter().find(|(known, _)| *known == name).copied()
}
