//! Contents as they are read from a dump and from the file of values.

use super::{DumpedPart, MAGIC, hash};
use crate::Error;
use flate2::read::ZlibDecoder;
use serde::Deserialize;
use serde_json::Value;
use shadowgraph_core::{ResourceDesc, Subresource};
use std::collections::HashMap;
use std::io::Read as _;

/// The contents of a dump, with what its passes read and write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct DumpedContents {
    /// Passes that run, in their order.
    pub(super) passes: Vec<PassContents>,
    pub(super) resources: Vec<ResourceContents>,
    pub(super) parts: Vec<PartContents>,
    /// The file of values; empty without one.
    values: Vec<u8>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PassContents {
    /// Its path, with a number if an earlier one has the same.
    pub(super) key: String,
    pub(super) accesses: Vec<AccessContents>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct AccessContents {
    pub(super) resource: usize,
    /// The version that is read, or overwritten.
    pub(super) version: u32,
    pub(super) part: Subresource,
    /// Whether the earlier contents matter.
    pub(super) reads: bool,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct ResourceContents {
    /// Its path, with a number if an earlier one has the same.
    pub(super) key: String,
    pub(super) desc: ResourceDesc,
}

/// A part of a resource after a pass.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct PartContents {
    /// The key of the pass; empty when the frame begins.
    pub(super) pass: String,
    pub(super) resource: usize,
    pub(super) version: u32,
    pub(super) part: Subresource,
    pub(super) hash: Option<String>,
    bytes: u64,
    values: Option<[u64; 2]>,
}

fn invalid(problem: &str) -> Error {
    Error::Dump { problem: problem.into() }
}

impl DumpedContents {
    /// Reads the field `contents` of a dump; `None` if it has none. `path` returns the path of a pass or a resource.
    pub(crate) fn from_dump(
        dump: &Value,
        path: &dyn Fn(&Value) -> Option<String>,
    ) -> Result<Option<Self>, Error> {
        let Some(contents) = dump.get("contents") else { return Ok(None) };
        let parts = Vec::<DumpedPart>::deserialize(contents)
            .map_err(|error| invalid(&format!("the field `contents`: {error}")))?;
        let plan = dump.get("plan").ok_or_else(|| invalid("missing field `plan`"))?;
        let (resources, keys, passes) = structure(plan, path).ok_or_else(|| invalid("a field is missing"))?;
        let parts =
            parts.into_iter().map(|part| Self::part(part, &resources, &keys)).collect::<Result<_, _>>()?;
        Ok(Some(Self { passes, resources, parts, values: Vec::new() }))
    }

    fn part(
        part: DumpedPart,
        resources: &[ResourceContents],
        keys: &[String],
    ) -> Result<PartContents, Error> {
        let DumpedPart { pass, resource, version, part, hash, bytes, values, .. } = part;
        let found = resources.get(resource as usize);
        let found =
            found.ok_or_else(|| invalid("`contents` names a resource that the frame does not have"))?;
        if !part.is_within(&found.desc) {
            return Err(invalid("`contents` has a part that its resource does not have"));
        }
        let pass = match pass {
            None => Some(String::new()),
            Some(pass) => keys.get(pass as usize).cloned(),
        };
        let pass = pass.ok_or_else(|| invalid("`contents` names a pass that the frame does not have"))?;
        Ok(PartContents { pass, resource: resource as usize, version, part, hash, bytes, values })
    }

    /// Adds the file of values.
    pub(crate) fn set_values(&mut self, values: Vec<u8>) -> Result<(), Error> {
        if !values.starts_with(MAGIC) {
            return Err(invalid("the file next to it is not one of values"));
        }
        let is_inside = |[start, length]: [u64; 2]| {
            start.checked_add(length).is_some_and(|end| end <= values.len() as u64)
        };
        if !self.parts.iter().filter_map(|part| part.values).all(is_inside) {
            return Err(invalid("its file of values is shorter than it says"));
        }
        self.values = values;
        Ok(())
    }

    /// Returns the bytes of a part; `None` if they are not in the file of values.
    ///
    /// # Errors
    /// If the bytes there are others than those of the dump.
    pub(super) fn bytes(&self, part: &PartContents) -> Result<Option<Vec<u8>>, Error> {
        let Some([start, length]) = part.values.filter(|_| !self.values.is_empty()) else { return Ok(None) };
        let range = start as usize..(start + length) as usize;
        let compressed = self.values.get(range).unwrap_or_default();
        let mut bytes = Vec::new();
        // No more than the dump says, whatever the file expands to.
        let read = ZlibDecoder::new(compressed).take(part.bytes.saturating_add(1)).read_to_end(&mut bytes);
        if read.is_err() || part.hash.as_deref() != Some(&hash(&bytes)) {
            return Err(invalid("its file of values does not belong to it, or is damaged"));
        }
        Ok(Some(bytes))
    }
}

type Structure = (Vec<ResourceContents>, Vec<String>, Vec<PassContents>);

/// Returns the resources, the keys of all passes, and the passes that run.
fn structure(plan: &Value, path: &dyn Fn(&Value) -> Option<String>) -> Option<Structure> {
    let mut seen: HashMap<String, usize> = HashMap::new();
    let mut key = |kind: &str, thing: &Value| -> Option<String> {
        let path = path(thing)?;
        let count = seen.entry(format!("{kind} {path}")).or_default();
        *count += 1;
        Some(if *count == 1 { path } else { format!("{path} ({count})") })
    };
    let resources: Vec<ResourceContents> = plan
        .get("resources")?
        .as_array()?
        .iter()
        .map(|resource| {
            let desc = ResourceDesc::deserialize(resource.get("desc")?).ok()?;
            Some(ResourceContents { key: key("resource", resource)?, desc })
        })
        .collect::<Option<_>>()?;
    let passes = plan.get("passes")?.as_array()?;
    let keys: Vec<String> = passes.iter().map(|pass| key("pass", pass)).collect::<Option<_>>()?;
    let mut running = Vec::new();
    for step in plan.get("order")?.as_array()? {
        for index in step.get("passes")?.as_array()? {
            let index = index.as_u64()? as usize;
            let accesses = passes.get(index)?.get("accesses")?.as_array()?;
            let accesses = accesses.iter().map(|access| self::access(access, &resources));
            let accesses = accesses.collect::<Option<_>>()?;
            running.push(PassContents { key: keys.get(index)?.clone(), accesses });
        }
    }
    Some((resources, keys, running))
}

fn access(access: &Value, resources: &[ResourceContents]) -> Option<AccessContents> {
    let resource = access.get("resource")?.as_u64()? as usize;
    let part = Subresource::deserialize(access.get("part")?).ok()?;
    resources.get(resource).filter(|found| part.is_within(&found.desc))?;
    Some(AccessContents {
        resource,
        version: u32::try_from(access.get("version")?.as_u64()?).ok()?,
        part,
        reads: matches!(access.get("contents")?, Value::Null) || access.get("contents")? == "Preserve",
    })
}
