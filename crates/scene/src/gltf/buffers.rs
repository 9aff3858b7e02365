//! The bytes of a file's buffers and the views into them.

use std::borrow::Cow;

use super::document::Document;
use super::error::{ImportError, WithLocation, describe};
use super::files::Files;
use super::uri;

/// The bytes of all buffers, each exactly as long as the file says.
#[derive(Debug)]
pub(super) struct Buffers<'a> {
    document: &'a Document,
    bytes: Vec<Cow<'a, [u8]>>,
}

/// The bytes of a buffer view.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    /// The stride of elements, bytes, if the file has one.
    pub(super) stride: Option<usize>,
}

impl<'a> Buffers<'a> {
    /// Reads all buffers: from the binary chunk, data URIs and files.
    ///
    /// # Errors
    /// The location names the buffer that is missing, too short or rejected.
    pub(super) fn read(
        document: &'a Document,
        bin: Option<&'a [u8]>,
        files: &Files,
    ) -> Result<Self, ImportError> {
        let mut bytes = Vec::with_capacity(document.buffers.len());
        for (i, buffer) in document.buffers.iter().enumerate() {
            let location = || describe("buffer", i, buffer.name.as_deref());
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
        Ok(Self { document, bytes })
    }

    /// Returns the document that the buffers belong to.
    pub(super) fn document(&self) -> &'a Document {
        self.document
    }

    /// Returns the bytes of a buffer view.
    ///
    /// # Errors
    /// The view does not exist, extends beyond its buffer, or has a stride out of range.
    pub(super) fn view(&self, index: usize) -> Result<View<'_>, String> {
        let missing = || format!("bufferView {index} does not exist");
        let view = self.document.buffer_views.get(index).ok_or_else(missing)?;
        let buffer = self.bytes.get(view.buffer.value()).ok_or_else(missing)?;
        let offset = view.byte_offset.map_or(0, |offset| offset.0);
        let bytes = offset
            .checked_add(view.byte_length.0)
            .and_then(|end| Some(usize::try_from(offset).ok()?..usize::try_from(end).ok()?))
            .and_then(|range| buffer.get(range));
        let bytes = bytes.ok_or_else(|| {
            format!(
                "bufferView {index} (byteOffset {offset}, byteLength {}) extends beyond buffer {} of {} bytes",
                view.byte_length.0,
                view.buffer.value(),
                buffer.len()
            )
        })?;
        let stride = view.byte_stride.map(|stride| stride.0);
        if let Some(stride) = stride.filter(|stride| !(4..=252).contains(stride)) {
            return Err(format!("bufferView {index} has a byteStride of {stride} (allowed: 4 to 252)"));
        }
        Ok(View { bytes, stride })
    }
}
