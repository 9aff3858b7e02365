//! A file together with those that it includes.

use std::path::Path;
use std::sync::Arc;

use super::document::Document;
use super::source::{PipelineError, Source, Spot};

/// Reads a file and all that it includes, each relative to the one that names it. What is included comes first; parameters,
/// tiers and outputs of the file itself take the place of those of the same name.
pub(super) fn read_all(file: &Path) -> Result<Document, PipelineError> {
    read_from(file, &file.display().to_string(), &mut Vec::new())
        .map_err(|failure| failure.unwrap_or_else(|error| unreadable(file, &error)))
}

fn unreadable(file: &Path, error: &std::io::Error) -> PipelineError {
    PipelineError { place: file.display().to_string(), problem: format!("cannot be read: {error}") }
}

/// Either it cannot be read, or something is wrong in it.
type Failure = Result<PipelineError, std::io::Error>;

fn read_from(file: &Path, name: &str, open: &mut Vec<std::path::PathBuf>) -> Result<Document, Failure> {
    let text = std::fs::read_to_string(file).map_err(Err)?;
    let path = file.canonicalize().map_err(Err)?;
    open.push(path);
    let source = Arc::new(Source { name: name.to_owned(), text });
    let own = Document::parse(&source).map_err(Ok)?;
    let folder = file.parent().unwrap_or(Path::new(""));
    let mut whole: Option<Document> = None;
    for included in &own.include {
        let other = folder.join(&included.value);
        if other.canonicalize().is_ok_and(|path| open.contains(&path)) {
            return Err(Ok(included.error(format!("`{}` includes itself by this", included.value))));
        }
        let document = read_from(&other, &other.display().to_string(), open).map_err(|failure| {
            Ok(failure.unwrap_or_else(|error| {
                included.error(format!("`{}` cannot be read: {error}", other.display()))
            }))
        })?;
        whole = Some(match whole {
            Some(before) => join(before, document).map_err(Ok)?,
            None => document,
        });
    }
    open.pop();
    match whole {
        Some(included) => join(included, own).map_err(Ok),
        None => Ok(own),
    }
}

fn join(mut first: Document, second: Document) -> Result<Document, PipelineError> {
    for entry in second.nodes {
        if let Some(known) = first.nodes.iter().find(|known| known.name.value == entry.name.value) {
            let (name, place) = (&entry.name.value, known.name.place.words());
            return Err(entry
                .name
                .error(format!("there is a node `{name}` already, at {place}: call it otherwise")));
        }
        first.nodes.push(entry);
    }
    replace(&mut first.parameters, second.parameters);
    replace(&mut first.tiers, second.tiers);
    replace(&mut first.tier_for, second.tier_for);
    replace(&mut first.outputs, second.outputs);
    Ok(Document { about: second.about, include: Vec::new(), ..first })
}

fn replace<T>(all: &mut Vec<(Spot<String>, T)>, others: Vec<(Spot<String>, T)>) {
    for (name, value) in others {
        all.retain(|(known, _)| known.value != name.value);
        all.push((name, value));
    }
}
