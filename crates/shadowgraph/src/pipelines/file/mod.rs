//! Pipelines from files: parse, resolve, build.

mod connect;
mod document;
mod enabled;
mod instance;
mod jitter;
mod order;
pub(crate) mod parameters;
mod renamed;
mod resolve;
pub(crate) mod schema;
mod source;
mod unused;

#[cfg(test)]
mod tests;

use std::path::Path;
use std::sync::Arc;

use shadowgraph_shadows::{Technique, Techniques};

use self::document::Document;
use self::instance::FileInstance;
use self::parameters::Parameters;
use self::resolve::{ResolvedNode, ResolvedPipeline};
use self::source::{Location, SourceText};
use super::instance::PipelineInstance;
use crate::build_context::BuildContext;
use crate::error::{Error, PipelineError};
use crate::nodes::built_in::shadows::Shadows;
use crate::nodes::built_in::sky::Sky;
use crate::nodes::node::Node;
use crate::nodes::registry::Nodes;

/// A file that was parsed and checked.
#[derive(Clone)]
pub(super) struct PipelineFile {
    pub(super) name: String,
    source: Arc<SourceText>,
    document: Arc<Document>,
    nodes: Nodes,
    pub(super) parameters: Parameters,
    resolved: Arc<ResolvedPipeline>,
    /// The technique that the file names.
    pub(super) technique: Option<Technique>,
    /// Whether shadows are computed in a screen-space mask.
    pub(super) screen_shadows: bool,
    /// Whether it has a node `sky`.
    pub(super) has_sky: bool,
}

impl PipelineFile {
    /// Reads and checks a file.
    pub(super) fn load(
        file: &Path,
        nodes: &Nodes,
        techniques: &Techniques,
        parameters: &Parameters,
    ) -> Result<Self, PipelineError> {
        let name = file.display().to_string();
        let text = std::fs::read_to_string(file).map_err(|error| PipelineError {
            location: name.clone(),
            problem: format!("cannot be read: {error}"),
        })?;
        Self::read(&name, &text, nodes, techniques, parameters)
    }

    /// Parses and checks a built-in file.
    pub(super) fn parse(name: &str, text: &str, parameters: &Parameters) -> Result<Self, PipelineError> {
        Self::read(name, text, &Nodes::built_in(), &Techniques::built_in(), parameters)
    }

    /// Parses and checks the text of a file.
    pub(super) fn read(
        name: &str,
        text: &str,
        nodes: &Nodes,
        techniques: &Techniques,
        parameters: &Parameters,
    ) -> Result<Self, PipelineError> {
        let source = Arc::new(SourceText { name: name.to_owned(), text: text.to_owned() });
        let document = Document::parse(&source)?;
        Self::checked(&source, document, nodes, techniques, parameters)
    }

    /// Returns the text.
    pub(super) fn text(&self) -> &str {
        &self.source.text
    }

    /// Checks the file with its default parameters and with those that are set.
    fn checked(
        source: &Arc<SourceText>,
        document: Document,
        nodes: &Nodes,
        techniques: &Techniques,
        parameters: &Parameters,
    ) -> Result<Self, PipelineError> {
        let document = Arc::new(document.with_current_names(nodes));
        document.check_parameters()?;
        Self::resolved(source, &document, nodes, techniques, &Parameters::default())?;
        // Any error that is left is due to the parameters.
        Self::resolved(source, &document, nodes, techniques, parameters)
            .map_err(|error| PipelineError { problem: format!("{}{parameters}", error.problem), ..error })
    }

    fn resolved(
        source: &Arc<SourceText>,
        document: &Arc<Document>,
        nodes: &Nodes,
        techniques: &Techniques,
        parameters: &Parameters,
    ) -> Result<Self, PipelineError> {
        let name = &source.name;
        let resolved = document.resolve(name, nodes, &document.parameter_values(name, parameters)?)?;
        let is_shadows = |node: &&ResolvedNode| node.kind.name == Shadows::NAME;
        let shadows = resolved.nodes.iter().find(is_shadows);
        let technique = shadows.map(|node| technique(document, node, techniques)).transpose()?.flatten();
        let screen_shadows =
            shadows.is_some_and(|node| node.settings.toggle(Shadows::SCREEN_SPACE).unwrap_or_default());
        let has_sky = resolved.nodes.iter().any(|node| node.kind.name == Sky::NAME);
        Ok(Self {
            name: name.clone(),
            source: source.clone(),
            document: document.clone(),
            nodes: nodes.clone(),
            parameters: parameters.clone(),
            resolved: Arc::new(resolved),
            technique,
            screen_shadows,
            has_sky,
        })
    }

    /// Returns the nodes whose `when` does not hold.
    pub(super) fn disabled_nodes(&self) -> impl Iterator<Item = &str> {
        let names = self.document.nodes.iter().map(|entry| entry.name.value.as_str());
        names.filter(|name| self.resolved.nodes.iter().all(|node| node.name != *name))
    }

    /// Returns warnings about what is valid and has no effect, or not the intended one.
    pub(super) fn warnings(&self) -> Vec<PipelineError> {
        let mut warnings = self.document.unused(&self.nodes, &self.resolved);
        warnings.extend(self.document.jitter_warnings(&self.resolved));
        warnings
    }

    /// Returns whether both have the same name and parameters.
    pub(super) fn has_same_source(&self, other: &Self) -> bool {
        (&self.name, &self.parameters) == (&other.name, &other.parameters)
    }

    pub(super) fn about(&self) -> &str {
        &self.document.about
    }

    pub(super) fn build(&self, context: &BuildContext<'_>) -> Result<Box<dyn PipelineInstance>, Error> {
        Ok(Box::new(FileInstance::new(self.resolved.clone(), context)?))
    }
}

/// Finds the technique that a `shadows` node names.
fn technique(
    document: &Document,
    node: &ResolvedNode,
    techniques: &Techniques,
) -> Result<Option<Technique>, PipelineError> {
    let name = node.settings.text(Shadows::TECHNIQUE).unwrap_or_default();
    if name.is_empty() {
        return Ok(None);
    }
    let location = || {
        let mut settings = document.entry(&node.name)?.settings.iter();
        let setting = settings.find(|(name, _)| name.value == Shadows::TECHNIQUE);
        setting.map(|(_, value)| Location::describe(&value.location))
    };
    techniques.find(name).map(Some).map_err(|error| PipelineError {
        location: location().unwrap_or_default(),
        problem: error.to_string(),
    })
}
