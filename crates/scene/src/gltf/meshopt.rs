//! Decoding of buffer views with EXT_meshopt_compression and KHR_meshopt_compression.

use ::gltf::json;
use meshoptimizer_rs::codec::{
    decode_filter_color, decode_filter_exp, decode_filter_oct, decode_filter_quat, decode_index_buffer,
    decode_index_sequence, decode_vertex_buffer,
};
use meshoptimizer_rs::{Error, Workspace};
use serde::Deserialize;

/// The extension and its successor, which adds a version of the codec and a filter.
pub(super) const NAMES: [&str; 2] = ["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// The compressed bytes of a buffer view, as in the file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", expecting = "an object of compressed bytes")]
pub(super) struct Compressed {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    byte_stride: usize,
    count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

/// What the bytes hold.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "UPPERCASE", expecting = "ATTRIBUTES, TRIANGLES or INDICES")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

/// How decoded attributes are converted.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(rename_all = "UPPERCASE", expecting = "NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Compressed {
    /// Reads the extension of a buffer view.
    ///
    /// # Errors
    /// A value has the wrong type.
    pub(super) fn read((name, value): (&str, &json::Value)) -> Result<Self, String> {
        Self::deserialize(value).map_err(|error| format!("{name}: {error}"))
    }

    /// Returns the number of decoded bytes; `None` if it exceeds the address space.
    pub(super) fn decoded_bytes(&self) -> Option<usize> {
        self.count.checked_mul(self.byte_stride)
    }

    /// Decodes the bytes.
    ///
    /// # Errors
    /// The bytes are not a stream of the codec, or do not hold what the extension says.
    pub(super) fn decode(&self, source: &[u8]) -> Result<Vec<u8>, Error> {
        let (count, stride) = (self.count, self.byte_stride);
        if self.mode != Mode::Attributes && self.filter != Filter::None {
            return Err(Error::InvalidParameter);
        }
        let mut workspace = Workspace::default();
        let decode = match self.mode {
            Mode::Attributes => decode_vertex_buffer,
            Mode::Triangles => decode_index_buffer,
            Mode::Indices => decode_index_sequence,
        };
        let mut bytes = decode(count, stride, source, &mut workspace)?;
        let filter = match self.filter {
            Filter::None => return Ok(bytes),
            Filter::Octahedral => decode_filter_oct,
            Filter::Quaternion => decode_filter_quat,
            Filter::Exponential => decode_filter_exp,
            Filter::Color => decode_filter_color,
        };
        filter(&mut bytes, count, stride, &mut workspace)?;
        Ok(bytes)
    }
}

/// Returns the extension of a buffer view and its name; `None` if its bytes are not compressed.
pub(super) fn extension(view: &json::buffer::View) -> Option<(&'static str, &json::Value)> {
    let extensions = &view.extensions.as_ref()?.others;
    NAMES.iter().find_map(|name| Some((*name, extensions.get(*name)?)))
}

/// Returns whether a buffer only holds bytes for programs without the extension. Its bytes may be missing.
pub(super) fn is_fallback(buffer: &json::Buffer) -> bool {
    let Some(extensions) = &buffer.extensions else { return false };
    let flag = |name: &&str| extensions.others.get(*name)?.get("fallback")?.as_bool();
    NAMES.iter().filter_map(flag).any(|fallback| fallback)
}
