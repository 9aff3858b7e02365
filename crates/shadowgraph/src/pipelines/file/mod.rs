//! Pipelines from files: read, include, choose, resolve, wire.

mod choose;
mod document;
mod include;
mod jitter;
mod resolve;
mod schema;
mod source;
mod unused;
mod wiring;

#[cfg(test)]
mod tests;

pub use choose::Choices;
pub use schema::schema;
pub use source::PipelineError;

use std::path::Path;
use std::sync::Arc;

use shadowgraph_shadows::{Technique, Techniques};

use self::document::Document;
use self::resolve::Resolved;
use self::source::{Place, Source};
use self::wiring::FileWiring;
use super::{Build, Wiring};
use crate::Error;
use crate::nodes::{Nodes, ShadowsNode, near_words};

/// A file that was read and checked.
#[derive(Clone)]
pub(super) struct PipelineFile {
    pub(super) name: String,
    document: Arc<Document>,
    nodes: Nodes,
    techniques: Techniques,
    choices: Choices,
    resolved: Arc<Resolved>,
    /// The technique that it insists on.
    pub(super) technique: Option<Technique>,
    /// Whether shadows are collected in a screen mask.
    pub(super) collected: bool,
}

impl PipelineError {
    pub(super) fn unknown(name: &str, known: &[&str]) -> Self {
        let near = near_words(name, known.iter().copied());
        Self { place: name.into(), problem: format!("there is no pipeline `{name}`{near}") }
    }
}

impl PipelineFile {
    /// Reads a file and what it includes.
    pub(super) fn load(
        file: &Path,
        nodes: &Nodes,
        techniques: &Techniques,
        choices: &Choices,
    ) -> Result<Self, PipelineError> {
        let document = Arc::new(include::read_all(file)?);
        Self::checked(&file.display().to_string(), document, nodes, techniques, choices)
    }

    /// Reads a built-in file.
    pub(super) fn of_text(name: &str, text: &str, choices: &Choices) -> Result<Self, PipelineError> {
        let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
        let document = Arc::new(Document::parse(&source)?);
        if let Some(include) = document.include.first() {
            return Err(include.error("a built-in pipeline includes nothing"));
        }
        Self::checked(name, document, &Nodes::built_in(), &Techniques::built_in(), choices)
    }

    /// Checks all tiers, and takes the choices.
    fn checked(
        name: &str,
        document: Arc<Document>,
        nodes: &Nodes,
        techniques: &Techniques,
        choices: &Choices,
    ) -> Result<Self, PipelineError> {
        document.check_parameters()?;
        for tier in document.all_choices() {
            Self::chosen(name, &document, nodes, techniques, &tier)?;
        }
        // What the file says by itself is right by now.
        Self::chosen(name, &document, nodes, techniques, choices)
            .map_err(|error| PipelineError { problem: format!("{}{choices}", error.problem), ..error })
    }

    /// Returns the nodes whose `when` does not hold.
    pub(super) fn left_out(&self) -> impl Iterator<Item = &str> {
        let names = self.document.nodes.iter().map(|entry| entry.name.value.as_str());
        names.filter(|name| self.resolved.nodes.iter().all(|node| node.name != *name))
    }

    /// Tells what serves nothing, or not what it is for.
    pub(super) fn warnings(&self) -> Vec<PipelineError> {
        let mut told = self.document.unused(&self.nodes, &self.resolved);
        told.extend(self.document.jitter_alone(&self.resolved));
        told
    }

    fn chosen(
        name: &str,
        document: &Arc<Document>,
        nodes: &Nodes,
        techniques: &Techniques,
        choices: &Choices,
    ) -> Result<Self, PipelineError> {
        let resolved = document.resolve(name, nodes, &document.choose(name, choices)?)?;
        let mut file = Self {
            name: name.to_owned(),
            document: document.clone(),
            nodes: nodes.clone(),
            techniques: techniques.clone(),
            choices: choices.clone(),
            resolved: Arc::new(resolved),
            technique: None,
            collected: false,
        };
        file.find_technique()?;
        Ok(file)
    }

    fn find_technique(&mut self) -> Result<(), PipelineError> {
        let of_shadows =
            |node: &&resolve::Placed| node.kind.name == <ShadowsNode as crate::nodes::Node>::NAME;
        let resolved = self.resolved.clone();
        let Some(node) = resolved.nodes.iter().find(of_shadows) else { return Ok(()) };
        let place = || {
            let entry = self.document.nodes.iter().find(|entry| entry.name.value == node.name);
            let setting = entry.and_then(|entry| {
                let mut settings = entry.settings.iter();
                settings.find(|(name, _)| name.value == ShadowsNode::TECHNIQUE).map(|(_, value)| &value.place)
            });
            setting.map_or_else(|| self.name.clone(), Place::words)
        };
        let refused = |problem: String| PipelineError { place: place(), problem };
        let asked = node.settings.text(ShadowsNode::TECHNIQUE).unwrap_or_default();
        let technique = (!asked.is_empty()).then(|| self.techniques.find(asked)).transpose();
        let technique = technique.map_err(|error| refused(error.to_string()))?;
        self.collected = node.settings.toggle(ShadowsNode::COLLECTED).unwrap_or_default();
        self.technique = technique;
        Ok(())
    }

    /// The same on a device of this kind, where no tier was asked for.
    pub(super) fn on(&self, device: &'static str) -> Result<Self, PipelineError> {
        let choices = Choices { device: Some(device), ..self.choices.clone() };
        Self::chosen(&self.name, &self.document, &self.nodes, &self.techniques, &choices)
    }

    /// Whether the same was chosen of a file of the same name.
    pub(super) fn is(&self, other: &Self) -> bool {
        let Choices { parameters, tier, device: _ } = &self.choices;
        (&self.name, parameters, tier) == (&other.name, &other.choices.parameters, &other.choices.tier)
    }

    pub(super) fn about(&self) -> &str {
        &self.document.about
    }

    pub(super) fn make(&self, build: &Build<'_>) -> Result<Box<dyn Wiring>, Error> {
        Ok(Box::new(FileWiring::new(self.resolved.clone(), build)?))
    }
}
