//! What the passes of a frame have written: a hash of each version in the dump, and values in a file next to it.

mod compare;
mod read;
mod texels;

pub use compare::{ContentsDiff, ContentsDifference, Tolerance};
pub(crate) use read::DumpedContents;
pub use texels::LargestDifference;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde::{Deserialize, Serialize};
use shadowgraph_core::{Contained, Plan, Subresource};
use std::io::Write as _;
use xxhash_rust::xxh3::xxh3_64;

/// The first bytes of a file of values.
const MAGIC: &[u8] = b"shadowgraph values 1\n";

/// Hashes what passes write, and keeps the values that fit.
///
/// Give [`add`](Self::add) to `Compiled::execute_visited`. [`dump`](Self::dump) is the frame's dump with hashes, and [`into_values`](Self::into_values)
/// the file next to it.
pub struct ContentsRecorder {
    max_bytes: usize,
    parts: Vec<DumpedPart>,
    values: Vec<u8>,
}

/// A part of a resource after a pass, as the dump has it.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct DumpedPart {
    /// The index of the pass; null when the frame begins.
    pass: Option<u32>,
    resource: u32,
    version: u32,
    part: Subresource,
    /// 16 hexadecimal digits; null if it could not be copied.
    hash: Option<String>,
    /// Why it could not be copied.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    problem: Option<String>,
    /// The bytes that were hashed.
    bytes: u64,
    /// Where the compressed bytes begin in the file of values, and their number; null if they are not there.
    values: Option<[u64; 2]>,
}

impl ContentsRecorder {
    /// Keeps values of up to `max_bytes` after compression; versions that no longer fit have only a hash.
    pub fn new(max_bytes: usize) -> Self {
        Self { max_bytes, parts: Vec::new(), values: MAGIC.to_vec() }
    }

    /// Adds what a pass has written.
    pub fn add(&mut self, contained: &Contained) {
        let Contained { pass, resource, version, part, bytes } = contained;
        let (pass, resource) = (pass.map(|pass| pass.index() as u32), resource.index() as u32);
        let (version, part) = (*version, *part);
        let values = bytes.as_ref().ok().and_then(|bytes| self.keep(bytes));
        self.parts.push(match bytes {
            Ok(bytes) => DumpedPart {
                pass,
                resource,
                version,
                part,
                hash: Some(hash(bytes)),
                problem: None,
                bytes: bytes.len() as u64,
                values,
            },
            Err(problem) => {
                let problem = Some(problem.clone());
                DumpedPart { pass, resource, version, part, hash: None, problem, bytes: 0, values: None }
            }
        });
    }

    /// Compresses and keeps bytes if they fit, and returns where.
    fn keep(&mut self, bytes: &[u8]) -> Option<[u64; 2]> {
        let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
        // Writing to memory does not fail.
        encoder.write_all(bytes).ok()?;
        let compressed = encoder.finish().ok()?;
        let start = self.values.len();
        (start + compressed.len() <= self.max_bytes).then(|| {
            self.values.extend(&compressed);
            [start as u64, compressed.len() as u64]
        })
    }

    /// Returns the field `contents` of a dump.
    ///
    /// # Errors
    /// Those of serde_json; contents cause none.
    pub fn to_json(&self) -> Result<serde_json::Value, serde_json::Error> {
        serde_json::to_value(&self.parts)
    }

    /// Returns the dump of a plan (as [`Plan::to_json`] writes it) with the field `contents`.
    ///
    /// # Errors
    /// Those of serde_json; a plan causes none.
    pub fn dump(&self, plan: &Plan) -> Result<String, serde_json::Error> {
        let mut document: serde_json::Value = serde_json::from_str(&plan.to_json()?)?;
        document["contents"] = self.to_json()?;
        serde_json::to_string_pretty(&document)
    }

    /// Returns how many versions have only a hash, because their values did not fit.
    pub fn left_out(&self) -> usize {
        self.parts.iter().filter(|part| part.hash.is_some() && part.values.is_none()).count()
    }

    /// Returns the file of values.
    pub fn into_values(self) -> Vec<u8> {
        self.values
    }
}

fn hash(bytes: &[u8]) -> String {
    format!("{:016x}", xxh3_64(bytes))
}
