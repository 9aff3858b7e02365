//! The bytes of a file's buffers and the views into them.

use std::borrow::Cow;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use ::gltf::json;

use super::document::Document;
use super::error::{ImportError, WithLocation, describe};
use super::files::Files;
use super::meshopt::{self, Compressed};
use super::uri;

/// The maximum number of bytes of decompressed buffer views in a scene.
const MAX_DECOMPRESSED_BYTES: usize = 1 << 30;

/// The bytes of all buffers, each exactly as long as the file says.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    document: &'a Document,
    bytes: Vec<Cow<'a, [u8]>>,
    /// The bytes of each compressed view, once it has been used.
    decompressed: Vec<OnceLock<Result<Vec<u8>, String>>>,
    /// The number of bytes that may still be decompressed.
    budget_bytes: AtomicUsize,
}

/// The bytes of a buffer view.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    /// The stride of elements, bytes, if the file has one.
    pub(super) stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers: from the binary chunk, data URIs and files. Buffers for programs without a compression are left
    /// empty.
    ///
    /// # Errors
    /// The location names the buffer that is missing, too short or rejected.
    pub(super) fn read(
        document: &'a Document,
        bin: Option<&'a [u8]>,
        files: &Files<'_>,
    ) -> Result<Self, ImportError> {
        let mut bytes = Vec::with_capacity(document.buffers.len());
        for (i, buffer) in document.buffers.iter().enumerate() {
            let location = || describe("buffer", i, buffer.name.as_deref());
            if meshopt::is_fallback(buffer) {
                bytes.push(Cow::Borrowed(&[][..]));
                continue;
            }
            let mut data = match (&buffer.uri, bin) {
                (Some(uri), _) => Cow::Owned(files.read(uri).with_location(location)?),
                (None, Some(bin)) if i == 0 => Cow::Borrowed(bin),
                (None, _) => {
                    return Err(ImportError::new(location(), "has no URI, and the file has no binary chunk"));
                }
            };
            let present = data.len();
            let length = usize::try_from(buffer.byte_length.0).ok().filter(|length| *length <= present);
            let Some(length) = length else {
                let from = buffer.uri.as_deref().map_or_else(|| "the binary chunk".into(), uri::quote);
                let reason =
                    format!("byteLength is {}, but {from} has {present} bytes", buffer.byte_length.0);
                return Err(ImportError::new(location(), reason));
            };
            match &mut data {
                Cow::Owned(data) => data.truncate(length),
                Cow::Borrowed(data) => *data = data.get(..length).unwrap_or_default(),
            }
            bytes.push(data);
        }
        let decompressed = document.buffer_views.iter().map(|_| OnceLock::new()).collect();
        let budget_bytes = AtomicUsize::new(MAX_DECOMPRESSED_BYTES);
        Ok(Self { document, bytes, decompressed, budget_bytes })
    }

    /// Returns the document that the buffers belong to.
    pub(super) fn document(&self) -> &'a Document {
        self.document
    }

    /// Returns the bytes of a buffer view, decompressed if they are compressed.
    ///
    /// # Errors
    /// The view does not exist, extends beyond its buffer, has a stride out of range, or cannot be decompressed.
    pub(super) fn view(&self, index: usize) -> Result<View<'_>, String> {
        let views = self.document.buffer_views.get(index).zip(self.decompressed.get(index));
        let (view, decompressed) = views.ok_or_else(|| format!("bufferView {index} does not exist"))?;
        let bytes = match meshopt::extension(view) {
            None => {
                let offset = view.byte_offset.map_or(0, |offset| offset.0);
                self.range(index, view.buffer.value(), offset, view.byte_length.0)?
            }
            Some(extension) => {
                let decompress = || self.decompress(index, view, &Compressed::read(extension)?);
                decompressed.get_or_init(decompress).as_deref().map_err(String::clone)?
            }
        };
        let stride = view.byte_stride.map(|stride| stride.0);
        if let Some(stride) = stride.filter(|stride| !(4..=252).contains(stride)) {
            return Err(format!("bufferView {index} has a byteStride of {stride} (allowed: 4 to 252)"));
        }
        Ok(View { bytes, stride })
    }

    /// Returns a range of a buffer for a view.
    fn range(&self, view: usize, buffer: usize, offset: u64, length: u64) -> Result<&[u8], String> {
        let Some(bytes) = self.bytes.get(buffer) else {
            return Err(format!("bufferView {view} is in buffer {buffer}, which does not exist"));
        };
        let range = offset
            .checked_add(length)
            .and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?))
            .and_then(|range| bytes.get(range));
        range.ok_or_else(|| {
            format!(
                "bufferView {view} (byteOffset {offset}, byteLength {length}) extends beyond buffer {buffer} of {} bytes",
                bytes.len()
            )
        })
    }

    fn decompress(
        &self,
        index: usize,
        view: &json::buffer::View,
        compressed: &Compressed,
    ) -> Result<Vec<u8>, String> {
        let (offset, length) = (compressed.byte_offset, compressed.byte_length);
        let source = self.range(index, compressed.buffer, offset, length)?;
        let expected = view.byte_length.0;
        let size = compressed.decoded_bytes().filter(|size| *size as u64 == expected);
        let size = size.ok_or_else(|| {
            format!("bufferView {index} has a byteLength of {expected} (allowed: count times byteStride)")
        })?;
        let take = |left: usize| left.checked_sub(size);
        if self.budget_bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, take).is_err() {
            return Err(format!(
                "bufferView {index} brings the decompressed bytes to more than {MAX_DECOMPRESSED_BYTES}, the limit"
            ));
        }
        compressed
            .decode(source)
            .map_err(|error| format!("bufferView {index} cannot be decompressed: {error}"))
    }
}
