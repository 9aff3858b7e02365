//! What differs between two frames, by their dumps.

mod facts;
mod html;

use crate::error::Error;
use crate::plan::Plan;
use facts::{Facts, facts};
use serde::Serialize;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// What a difference is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Subject {
    /// A group of passes.
    Node,
    /// A pass: its kind.
    Pass,
    /// A texture or buffer: its shape, where it comes from and its usages.
    Resource,
    /// Why something is as it is.
    Decision,
}

/// One thing that is not the same in both frames.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Difference {
    /// What kind of thing.
    pub subject: Subject,
    /// Which: a path, a name, or of a decision the pass, the resource and part, and what was decided, with ` · ` between.
    pub name: String,
    /// How it was in the first frame; `None` if it was not there.
    pub before: Option<String>,
    /// How it is in the second frame; `None` if it is not there.
    pub after: Option<String>,
}

/// What differs between two frames. Things are known by their names; where several have one name, those that are alike in both
/// frames are no difference, and the others are compared in their order.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Diff {
    /// By subject, then by name.
    pub differences: Vec<Difference>,
}

impl Diff {
    /// Compares two dumps, as [`Plan::to_json`] writes them.
    ///
    /// # Errors
    /// [`Error::Dump`] where a text is no dump, or one of another schema.
    pub fn of_json(before: &str, after: &str) -> Result<Self, Error> {
        let (before, after) = (facts(before, "the first")?, facts(after, "the second")?);
        let keys: BTreeSet<_> = before.keys().chain(after.keys()).collect();
        let of = |facts: &Facts, key| facts.get(key).cloned().unwrap_or_default();
        let mut differences = Vec::new();
        for key in keys {
            let (mut was, mut is) = (of(&before, key), of(&after, key));
            // What is in both, in whichever order, is no difference.
            was.retain(|fact| is.iter().position(|other| other == fact).map(|at| is.remove(at)).is_none());
            let mut is = is.into_iter();
            let mut add = |before, after| {
                differences.push(Difference { subject: key.0, name: key.1.clone(), before, after });
            };
            was.into_iter().for_each(|fact| add(Some(fact), is.next()));
            is.for_each(|fact| add(None, Some(fact)));
        }
        Ok(Self { differences })
    }

    /// Returns whether the frames are the same in all that is compared.
    pub fn is_empty(&self) -> bool {
        self.differences.is_empty()
    }

    /// Returns those about one subject.
    pub fn about(&self, subject: Subject) -> impl Iterator<Item = &Difference> {
        self.differences.iter().filter(move |difference| difference.subject == subject)
    }

    /// Returns the differences as text: `-` for what went, `+` for what came, `~` for what changed.
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
            for Difference { name, before, after, .. } in self.about(subject) {
                let _ = match (before, after) {
                    (Some(was), Some(is)) => writeln!(out, "  ~ {name}\n      - {was}\n      + {is}"),
                    (Some(was), None) => writeln!(out, "  - {}", line(name, was)),
                    (None, Some(is)) => writeln!(out, "  + {}", line(name, is)),
                    (None, None) => Ok(()),
                };
            }
        }
        out
    }
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
    /// assert_eq!(diff.differences[0].name, "scene");
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    ///
    /// # Errors
    /// None that a plan can cause.
    pub fn diff(&self, after: &Self) -> Result<Diff, Error> {
        let json = |plan: &Self| plan.to_json().map_err(|error| Error::Dump { problem: error.to_string() });
        Diff::of_json(&json(self)?, &json(after)?)
    }
}

impl Subject {
    const ALL: [Self; 4] = [Self::Node, Self::Pass, Self::Resource, Self::Decision];

    fn plural(self) -> &'static str {
        match self {
            Self::Node => "nodes",
            Self::Pass => "passes",
            Self::Resource => "resources",
            Self::Decision => "decisions",
        }
    }
}

fn line(name: &str, what: &str) -> String {
    if what.is_empty() { name.to_owned() } else { format!("{name}: {what}") }
}

#[cfg(test)]
mod tests;
