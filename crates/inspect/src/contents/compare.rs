//! Comparing what the passes of two frames have written.

use super::read::{DumpedContents, PartContents, PassContents};
use super::texels::{self, LargestDifference, ValueDifference};
use crate::Error;
use serde::Serialize;
use shadowgraph_core::Subresource;
use std::collections::HashMap;

/// What counts as equal where values are compared. The default: only equal bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tolerance {
    /// Numbers are equal if they differ by at most this times the larger one, or times 1 if both are smaller.
    pub relative: f64,
    /// A version is equal if at most this fraction of its texels (of buffers, words of four bytes) differs, such as some at the edges of triangles,
    /// which drivers round differently.
    pub outliers: f64,
}

/// Differences of what the passes of two frames have written.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ContentsDiff {
    /// Number of versions that were compared, parts of textures one by one.
    pub compared: usize,
    /// Number of those that differ.
    pub differing: usize,
    /// Number of those that differ and have no values in both files, so that no tolerance applies.
    pub only_hashes: usize,
    /// Number of versions that could not be compared, such as textures with several samples.
    pub unknown: usize,
    /// The first difference; if there is any, that of a pass whose inputs are equal.
    pub first: Option<ContentsDifference>,
}

/// A part of a resource that differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContentsDifference {
    /// The path of the pass that wrote it; `None` when the frame begins.
    pub pass: Option<String>,
    /// Whether all that the pass read is equal.
    pub from_equal_inputs: bool,
    /// The path of the texture or buffer.
    pub resource: String,
    /// Its version in the first frame.
    pub version: u32,
    /// The part.
    pub part: Subresource,
    /// Number of texels (of buffers, words of four bytes) that differ, and of how many; `None` without values.
    pub texels: Option<[u64; 2]>,
    /// The largest difference; `None` without values, and for compressed and packed formats.
    pub largest: Option<LargestDifference>,
}

/// How a part compares with that of the other frame.
enum Outcome {
    Equal,
    Unknown,
    /// With values, how they differ.
    Differs(Option<ValueDifference>),
}

impl Outcome {
    fn differs(&self) -> bool {
        matches!(self, Self::Differs(_))
    }
}

impl DumpedContents {
    /// Compares this frame with another.
    ///
    /// # Errors
    /// If a file of values is not that of its dump.
    pub(crate) fn diff(&self, after: &Self, tolerance: Tolerance) -> Result<ContentsDiff, Error> {
        let others: HashMap<_, _> = after.parts.iter().map(|part| (after.key(part), part)).collect();
        let outcome = |part| match others.get(&self.key(part)) {
            Some(other) => self.outcome(part, (after, other), tolerance),
            // Of passes that are in one frame only, nothing is compared.
            None => Ok(Outcome::Unknown),
        };
        let outcomes = self.parts.iter().map(outcome).collect::<Result<Vec<_>, _>>()?;
        let count = |is: &dyn Fn(&Outcome) -> bool| outcomes.iter().filter(|outcome| is(outcome)).count();
        let unknown = count(&|outcome| matches!(outcome, Outcome::Unknown));
        Ok(ContentsDiff {
            compared: outcomes.len() - unknown,
            differing: count(&Outcome::differs),
            only_hashes: count(&|outcome| matches!(outcome, Outcome::Differs(None))),
            unknown,
            first: self.first(&outcomes, after),
        })
    }

    fn outcome(
        &self,
        part: &PartContents,
        (after, other): (&Self, &PartContents),
        tolerance: Tolerance,
    ) -> Result<Outcome, Error> {
        let (Some(was), Some(is)) = (&part.hash, &other.hash) else { return Ok(Outcome::Unknown) };
        if was == is {
            return Ok(Outcome::Equal);
        }
        let (Some(was), Some(is)) = (self.bytes(part)?, after.bytes(other)?) else {
            return Ok(Outcome::Differs(None));
        };
        let desc = &self.resources[part.resource].desc;
        if was.len() != is.len() || *desc != after.resources[other.resource].desc {
            return Ok(Outcome::Differs(None));
        }
        let values = texels::compare(desc, &part.part, [&was, &is], tolerance.relative);
        let is_equal = values.count as f64 <= tolerance.outliers * values.of as f64;
        Ok(if is_equal { Outcome::Equal } else { Outcome::Differs(Some(values)) })
    }

    /// Returns what identifies a part in both frames.
    fn key<'s>(&'s self, part: &'s PartContents) -> (&'s str, &'s str, Subresource) {
        (&part.pass, &self.resources[part.resource].key, part.part)
    }

    fn first(&self, outcomes: &[Outcome], after: &Self) -> Option<ContentsDifference> {
        let differing = || (0..self.parts.len()).filter(|&index| outcomes[index].differs());
        let mut written: HashMap<&str, Vec<usize>> = HashMap::new();
        for index in differing() {
            written.entry(&self.parts[index].pass).or_default().push(index);
        }
        let describe = |index: usize, from_equal_inputs| self.describe(index, outcomes, from_equal_inputs);
        if let Some(initial) = written.get("") {
            return initial.first().map(|&index| describe(index, true));
        }
        let is_in_both = |pass: &&PassContents| after.passes.iter().any(|other| other.key == pass.key);
        let culprit = self.passes.iter().filter(is_in_both).find_map(|pass| {
            let index = *written.get(&*pass.key)?.first()?;
            self.inputs_are_equal(pass, outcomes).then_some(index)
        });
        culprit
            .map(|index| describe(index, true))
            .or_else(|| differing().next().map(|index| describe(index, false)))
    }

    /// Returns whether nothing differs of what a pass reads.
    fn inputs_are_equal(&self, pass: &PassContents, outcomes: &[Outcome]) -> bool {
        pass.accesses.iter().filter(|access| access.reads).all(|access| {
            let desc = &self.resources[access.resource].desc;
            let mut earlier: Vec<usize> = (0..self.parts.len())
                .filter(|&index| {
                    let part = &self.parts[index];
                    part.resource == access.resource
                        && part.version <= access.version
                        && part.part.overlaps(&access.part, desc)
                })
                .collect();
            earlier.sort_by_key(|&index| std::cmp::Reverse(self.parts[index].version));
            // What lies under a part that covers the access is not read.
            let covering =
                earlier.iter().position(|&index| self.parts[index].part.contains(&access.part, desc));
            let read = covering.map_or(earlier.len(), |covering| covering + 1);
            earlier[..read].iter().all(|&index| !outcomes[index].differs())
        })
    }

    fn describe(&self, index: usize, outcomes: &[Outcome], from_equal_inputs: bool) -> ContentsDifference {
        let part = &self.parts[index];
        let values = match &outcomes[index] {
            Outcome::Differs(Some(values)) => Some(values),
            _ => None,
        };
        ContentsDifference {
            pass: Some(part.pass.clone()).filter(|pass| !pass.is_empty()),
            from_equal_inputs,
            resource: self.resources[part.resource].key.clone(),
            version: part.version,
            part: part.part,
            texels: values.map(|values| [values.count, values.of]),
            largest: values.and_then(|values| values.largest.clone()),
        }
    }
}

impl ContentsDiff {
    /// Returns the differences as a text of some lines.
    pub fn to_text(&self) -> String {
        let Self { compared, differing, only_hashes, unknown, first } = self;
        let mut text = match first {
            None => format!("contents: all {compared} versions are equal\n"),
            Some(first) => format!("contents: {first}\n  {differing} of {compared} versions differ\n"),
        };
        if *only_hashes > 0 {
            text += &format!(
                "  {only_hashes} of them are compared by hash alone, as there is no file of values, or it has not theirs\n"
            );
        }
        if *unknown > 0 {
            text += &format!("  {unknown} versions could not be compared\n");
        }
        text
    }
}

impl std::fmt::Display for ContentsDifference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { pass, from_equal_inputs, resource, version, part, texels, largest } = self;
        let part = if *part == Subresource::FULL { String::new() } else { format!(" ({part})") };
        match pass {
            None => write!(f, "`{resource}`{part} differs when the frame begins")?,
            Some(pass) => {
                let inputs =
                    if *from_equal_inputs { "from equal inputs" } else { "from inputs that differ too" };
                write!(f, "`{pass}` writes `{resource}` v{version}{part} differently, {inputs}")?;
            }
        }
        if let Some([count, of]) = texels {
            write!(f, ": {count} of {of} values")?;
        }
        if let Some(LargestDifference { at, before, after }) = largest {
            let join = |values: &[f64]| {
                values.iter().map(|&value| (value as f32).to_string()).collect::<Vec<_>>().join(" ")
            };
            let place = match at[..] {
                [byte] => format!("byte {byte}"),
                [x, y, 0] => format!("{x},{y}"),
                [x, y, layer] => format!("{x},{y}, layer {layer}"),
                _ => String::new(),
            };
            write!(f, ", most at {place}: {} before, {} after", join(before), join(after))?;
        }
        Ok(())
    }
}
