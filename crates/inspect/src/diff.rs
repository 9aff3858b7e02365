//! Differences between two frames, by their dumps.

mod facts;
mod html;

use crate::Error;
use crate::contents::{ContentsDiff, Tolerance};
pub use facts::Dump;
use facts::Facts;
use serde::Serialize;
use shadowgraph_core::Plan;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The kind of thing that a difference is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Subject {
    /// A count or the memory of the whole frame.
    Summary,
    /// A node: a group of passes.
    Node,
    /// A pass: its kind.
    Pass,
    /// A texture or buffer: its shape, where it comes from and its usages.
    Resource,
    /// An access: how a pass uses a resource, and which version.
    Access,
    /// A decision, with its reason.
    Decision,
}

/// One difference between the frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// The kind of thing that differs.
    pub subject: Subject,
    /// A path; for an access the pass and the resource; for a decision also the subresource and the name of the decision, separated
    /// by ` · `.
    pub name: String,
    /// State in the first frame; `None` if it is missing there.
    pub before: Option<String>,
    /// State in the second frame; `None` if it is missing there.
    pub after: Option<String>,
    /// Whether only the numbers of steps, slots and versions differ, as they do for everything after an added pass.
    pub only_numbers: bool,
}

/// Differences between two frames. Things are identified by name; if several have the same name, those that are equal in both
/// frames are left out and the others are compared in order.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Diff {
    /// Differences by subject, then by name.
    pub differences: Vec<Difference>,
    /// Differences of what passes have written, if both dumps say what that is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contents: Option<ContentsDiff>,
}

impl Dump {
    /// Compares this frame with another.
    ///
    /// ```
    /// use shadowgraph_core::Frame;
    /// use shadowgraph_inspect::Dump;
    /// let dump = Dump::from_json(&Frame::new().compile()?.plan().to_json()?)?;
    /// assert!(dump.diff(&dump).is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn diff(&self, after: &Self) -> Diff {
        let (before, after) = (&self.facts, &after.facts);
        let keys: BTreeSet<_> = before.keys().chain(after.keys()).collect();
        let facts_of = |facts: &Facts, key| facts.get(key).cloned().unwrap_or_default();
        let mut differences = Vec::new();
        for key in keys {
            let (mut was, mut is) = (facts_of(before, key), facts_of(after, key));
            // Facts that are in both, in any order, do not differ.
            was.retain(|fact| is.iter().position(|other| other == fact).map(|at| is.remove(at)).is_none());
            let mut is = is.into_iter();
            let mut add = |before: Option<String>, after: Option<String>| {
                let only_numbers = match (&before, &after) {
                    (Some(before), Some(after)) => {
                        key.0 != Subject::Summary && without_numbers(before) == without_numbers(after)
                    }
                    _ => false,
                };
                differences.push(Difference {
                    subject: key.0,
                    name: key.1.clone(),
                    before,
                    after,
                    only_numbers,
                });
            };
            was.into_iter().for_each(|fact| add(Some(fact), is.next()));
            is.for_each(|fact| add(None, Some(fact)));
        }
        Diff { differences, contents: None }
    }

    /// Compares this frame with another like [`diff`](Self::diff), and what their passes have written too, if both dumps
    /// [say so](Self::has_contents). The tolerance applies where both have [values](Self::with_values).
    ///
    /// # Errors
    /// [`Error::Dump`] if a file of values is not that of its dump.
    pub fn diff_with_contents(&self, after: &Self, tolerance: Tolerance) -> Result<Diff, Error> {
        let contents = match (&self.contents, &after.contents) {
            (Some(before), Some(after)) => Some(before.diff(after, tolerance)?),
            _ => None,
        };
        Ok(Diff { contents, ..self.diff(after) })
    }
}

impl Diff {
    /// Returns whether the frames are the same in all that is compared.
    pub fn is_empty(&self) -> bool {
        self.differences.is_empty() && self.contents.as_ref().is_none_or(|contents| contents.first.is_none())
    }

    /// Returns the differences about one subject.
    pub fn about(&self, subject: Subject) -> impl Iterator<Item = &Difference> {
        self.differences.iter().filter(move |difference| difference.subject == subject)
    }

    /// Returns the differences as text: `-` for removed, `+` for added, `~` for changed. Differences only in numbers are
    /// counted.
    pub fn to_text(&self) -> String {
        let mut out = self.contents.as_ref().map(ContentsDiff::to_text).unwrap_or_default();
        if self.differences.is_empty() {
            out += match self.contents {
                None => "the frames do not differ\n",
                Some(_) => "the plans do not differ\n",
            };
            return out;
        }
        for subject in Subject::ALL {
            if self.about(subject).next().is_none() {
                continue;
            }
            let _ = writeln!(out, "{}", subject.plural());
            for Difference { name, before, after, .. } in self.about(subject).filter(|d| !d.only_numbers) {
                let _ = match (before, after) {
                    (Some(was), Some(is)) => writeln!(out, "  ~ {name}\n      - {was}\n      + {is}"),
                    (Some(was), None) => writeln!(out, "  - {}", line(name, was)),
                    (None, Some(is)) => writeln!(out, "  + {}", line(name, is)),
                    (None, None) => Ok(()),
                };
            }
            if let Some(count) = self.describe_number_changes(subject) {
                let _ = writeln!(out, "  {count}");
            }
        }
        out
    }

    /// Counts the differences about a subject that are only in numbers; `None` for none.
    fn describe_number_changes(&self, subject: Subject) -> Option<String> {
        match self.about(subject).filter(|difference| difference.only_numbers).count() {
            0 => None,
            1 => Some("1 differs only in the number of a step, slot or version".into()),
            many => Some(format!("{many} differ only in the numbers of steps, slots or versions")),
        }
    }
}

/// Removes the numbers after `step`, `slot` and `version`.
fn without_numbers(text: &str) -> String {
    let numbered = |word: &str| ["step", "slot", "version"].contains(&word);
    let mut words: Vec<&str> = text.split(' ').collect();
    for at in 1..words.len() {
        if numbered(words[at - 1]) {
            words[at] = words[at].trim_start_matches(|c: char| c.is_ascii_digit());
        }
    }
    words.join(" ")
}

/// Compares two frames by their plans.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
/// use shadowgraph_inspect::diff;
/// let plan = |width| {
///     let mut frame = Frame::new();
///     let mut scene = frame.create_texture("scene", TextureDesc::d2(width, 64, Format::Rgba16Float));
///     frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
///     frame.export_texture(&scene);
///     frame.compile().map(|compiled| compiled.into_plan())
/// };
/// assert!(diff(&plan(64)?, &plan(64)?)?.is_empty());
/// let wider = diff(&plan(64)?, &plan(128)?)?;
/// assert!(wider.to_text().contains("scene"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A plan causes none.
pub fn diff(before: &Plan, after: &Plan) -> Result<Diff, Error> {
    Ok(Dump::from_plan(before)?.diff(&Dump::from_plan(after)?))
}

impl Subject {
    const ALL: [Self; 6] =
        [Self::Summary, Self::Node, Self::Pass, Self::Resource, Self::Access, Self::Decision];

    fn plural(self) -> &'static str {
        match self {
            Self::Summary => "counts",
            Self::Node => "nodes",
            Self::Pass => "passes",
            Self::Resource => "resources",
            Self::Access => "accesses",
            Self::Decision => "decisions",
        }
    }
}

fn line(name: &str, what: &str) -> String {
    if what.is_empty() { name.to_owned() } else { format!("{name}: {what}") }
}

#[cfg(test)]
mod tests;
