//! What differs between two frames, by their dumps.

mod facts;
mod html;

use crate::error::Error;
use crate::plan::Plan;
pub use facts::Dump;
use facts::Facts;
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// What a difference is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Subject {
    /// A count of the whole frame, or its memory.
    Summary,
    /// A group of passes.
    Node,
    /// A pass: its kind.
    Pass,
    /// A texture or buffer: its shape, where it comes from and its usages.
    Resource,
    /// What a pass does with a resource, and at which version.
    Access,
    /// Why something is as it is.
    Decision,
}

/// One thing that is not the same in both frames.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// What kind of thing.
    pub subject: Subject,
    /// Which: a path; of an access the pass, the resource and the part; of a decision those and what was decided. With ` · `
    /// between them.
    pub name: String,
    /// How it was in the first frame; `None` if it was not there.
    pub before: Option<String>,
    /// How it is in the second frame; `None` if it is not there.
    pub after: Option<String>,
    /// Whether nothing but the numbers of steps, slots and versions differs, as it does for all that follows a pass that came.
    pub only_numbers: bool,
}

/// What differs between two frames. Things are known by their names; where several have one name, those that are alike in both
/// frames are no difference, and the others are compared in their order.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Diff {
    /// By subject, then by name.
    pub differences: Vec<Difference>,
}

impl Dump {
    /// Says what differs between this frame and another.
    ///
    /// ```
    /// use shadowgraph_core::{Dump, Frame};
    /// let dump = Dump::from_json(&Frame::new().compile()?.plan().to_json()?)?;
    /// assert!(dump.diff(&dump).is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn diff(&self, after: &Self) -> Diff {
        let (before, after) = (&self.facts, &after.facts);
        let keys: BTreeSet<_> = before.keys().chain(after.keys()).collect();
        let of = |facts: &Facts, key| facts.get(key).cloned().unwrap_or_default();
        let mut differences = Vec::new();
        for key in keys {
            let (mut was, mut is) = (of(before, key), of(after, key));
            // What is in both, in whichever order, is no difference.
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
        Diff { differences }
    }
}

impl Diff {
    /// Returns whether the frames are the same in all that is compared.
    pub fn is_empty(&self) -> bool {
        self.differences.is_empty()
    }

    /// Returns those about one subject.
    pub fn about(&self, subject: Subject) -> impl Iterator<Item = &Difference> {
        self.differences.iter().filter(move |difference| difference.subject == subject)
    }

    /// Returns the differences as text: `-` for what went, `+` for what came, `~` for what changed. Of those in which only
    /// numbers differ it tells how many there are.
    pub fn to_text(&self) -> String {
        if self.is_empty() {
            return "the frames do not differ\n".into();
        }
        let mut out = String::new();
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
            if let Some(words) = self.numbers_words(subject) {
                let _ = writeln!(out, "  {words}");
            }
        }
        out
    }

    /// How many differences about a subject are in numbers only; `None` for none.
    fn numbers_words(&self, subject: Subject) -> Option<String> {
        match self.about(subject).filter(|difference| difference.only_numbers).count() {
            0 => None,
            1 => Some("1 differs only in the number of a step, slot or version".into()),
            many => Some(format!("{many} differ only in the numbers of steps, slots or versions")),
        }
    }
}

/// The text without the numbers behind `step`, `slot` and `version`.
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

impl Plan {
    /// Says what differs between this frame and another.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, TextureDesc};
    /// let plan = |width| {
    ///     let mut frame = Frame::new();
    ///     let mut scene = frame.create_texture("scene", TextureDesc::d2(width, 64, Format::Rgba16Float));
    ///     frame.render_pass("draw").color(&mut scene, Contents::clear_color([0.0; 4]));
    ///     frame.export_texture(&scene);
    ///     frame.compile().map(|compiled| compiled.into_plan())
    /// };
    /// assert!(plan(64)?.diff(&plan(64)?)?.is_empty());
    /// let diff = plan(64)?.diff(&plan(128)?)?;
    /// assert!(diff.to_text().contains("scene"));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    ///
    /// # Errors
    /// None that a plan can cause.
    pub fn diff(&self, after: &Self) -> Result<Diff, Error> {
        Ok(Dump::of(self)?.diff(&Dump::of(after)?))
    }
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
