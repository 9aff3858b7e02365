//! Errors of the graph. Every message names the pass, the resource and a fix.

use crate::pass_name::PassName;

/// An error in the declaration of a frame, or while it is executed.
///
/// Each has a [`code`](Self::code) that never changes and begins the message; `docs/errors.md` has a section with
/// an example for each code. Passes have the [`PassName`] with the place in the source that declared them.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the fields are named as in the message above them")]
pub enum Error {
    /// A read through a stale handle.
    #[error(
        "SG0101: {location} reads version {version} of `{resource}`, but {writer} has since written version \
         {latest}; read before that write, or use the handle that was passed to it by `&mut` (export last)"
    )]
    StaleRead { location: String, resource: String, version: u32, writer: PassName, latest: u32 },
    /// Two passes write the same version.
    #[error(
        "SG0102: pass {pass} writes version {version} of `{resource}`, which {writer} has already \
         overwritten; pass the same handle by `&mut` to both, not a clone from before the first write"
    )]
    TwoWriters { pass: PassName, resource: String, version: u32, writer: PassName },
    /// A handle or token of another frame.
    #[error(
        "SG0103: {location} uses a handle of another frame; handles are valid for one frame, so keep \
         contents in a history, or import your own texture or buffer"
    )]
    ForeignHandle { location: String },
    /// A token was used in a pass that did not declare the access.
    #[error(
        "SG0104: pass {pass} uses `{resource}` without declaring the access (the token belongs to \
         {declared_by}); declare the access on the pass that uses it, and use the token that it returns"
    )]
    Undeclared { pass: PassName, resource: String, declared_by: PassName },
    /// A read of undefined contents.
    #[error(
        "SG0201: {location} reads {subresource} of `{resource}`, which is not fully defined; write all of it in \
         earlier passes (clear or overwrite), or import it as defined"
    )]
    UndefinedRead { location: String, resource: String, subresource: String },
    /// A preserving write over undefined contents.
    #[error(
        "SG0202: pass {pass} preserves {subresource} of `{resource}`, which is not fully defined; use \
         `Contents::Clear` or `Contents::Overwrite` for the first write"
    )]
    UndefinedPreserve { pass: PassName, resource: String, subresource: String },
    /// Conflicting accesses to a resource in one pass.
    #[error(
        "SG0203: pass {pass} uses `{resource}` as {first} and as {second}, which conflict in one pass; \
         split the pass, or write to another texture, buffer, mip or layer"
    )]
    Conflict { pass: PassName, resource: String, first: String, second: String },
    /// A write to the previous contents of a history.
    #[error(
        "SG0204: pass {pass} writes `{resource}`, the previous contents of a history; write the history's \
         `current` instead"
    )]
    PreviousWritten { pass: PassName, resource: String },
    /// A render pass without an attachment.
    #[error(
        "SG0301: render pass {pass} has no attachment; give it a colour or depth attachment, or make it a \
         compute pass"
    )]
    NoAttachment { pass: PassName },
    /// Attachments that differ in size or sample count.
    #[error(
        "SG0302: the attachments of pass {pass} differ: {first}, {second}; give them the same size and \
         sample count"
    )]
    AttachmentMismatch { pass: PassName, first: String, second: String },
    /// An attachment of several mips or layers.
    #[error(
        "SG0303: pass {pass} attaches {subresource} of `{resource}`, but an attachment is one mip of one layer; \
         narrow it with `subresource(Subresource::FULL.mip(..).layer(..))`"
    )]
    AttachmentSubresource { pass: PassName, resource: String, subresource: String },
    /// A format that does not support the access.
    #[error("SG0304: pass {pass} uses `{resource}` as {access}, but its format {format:?} {problem}")]
    Format {
        pass: PassName,
        resource: String,
        access: &'static str,
        format: crate::Format,
        problem: &'static str,
    },
    /// An invalid clear value.
    #[error("SG0305: pass {pass} clears `{resource}` with {problem}")]
    Clear { pass: PassName, resource: String, problem: &'static str },
    /// An invalid resolve.
    #[error("SG0306: pass {pass} resolves into `{resource}`, but {problem}")]
    Resolve { pass: PassName, resource: String, problem: String },
    /// A second depth attachment.
    #[error(
        "SG0307: pass {pass} has the depth attachments `{first}` and `{second}`, but a render pass has \
         only one; split the pass in two"
    )]
    SecondDepth { pass: PassName, first: String, second: String },
    /// A copy between incompatible resources.
    #[error("SG0308: pass {pass} cannot copy {from} to {to}: {problem}")]
    CopyMismatch { pass: PassName, from: String, to: String, problem: String },
    /// An invalid texture, buffer or history.
    #[error("SG0401: `{resource}` is invalid: {problem}")]
    InvalidResource { resource: String, problem: String },
    /// A subresource out of range.
    #[error("SG0402: pass {pass} uses {subresource} of `{resource}`, but {problem}")]
    InvalidSubresource { pass: PassName, resource: String, subresource: String, problem: &'static str },
    /// An imported resource lacks a usage.
    #[error(
        "SG0403: pass {pass} uses imported `{resource}` as {access}, but it was created without \
         {needed}; add that usage where you create it"
    )]
    ImportUsage { pass: PassName, resource: String, access: &'static str, needed: String },
    /// An import was declared without an object.
    #[error(
        "SG0404: `{resource}` was declared as an import without an object; use `import_texture` or \
         `import_buffer`"
    )]
    NoImport { resource: String },
    /// An impossible pass order.
    #[error(
        "SG0501: pass {pass} must run after pass {other}, which is not declared before it; use the id \
         of an earlier pass"
    )]
    Order { pass: PassName, other: u32 },
    /// No published value of a type.
    #[error(
        "SG0502: {location} looks up `{value}`, which no earlier node has published; add the node that \
         publishes it, or move that node before this one"
    )]
    NotPublished { location: String, value: &'static str },
    /// A resource is larger than the device allows.
    #[error(
        "SG0601: `{resource}` needs {needed} ({limit}), but this device allows {allowed}; make it smaller, \
         or request the device with a higher limit"
    )]
    Limit { resource: String, limit: &'static str, needed: u64, allowed: u64 },
    /// A pass body failed.
    #[error("SG0602: pass {pass}: {message}")]
    Body { pass: PassName, message: String },
    /// A resource that cannot be read back.
    #[error("SG0603: `{resource}` cannot be read back: {problem}")]
    ReadBack { resource: String, problem: String },
    /// A shader that does not compile or does not match its pass.
    #[error("SG0604: shader `{shader}` does not compile or does not match its pass: {message}")]
    Shader { shader: String, message: String },
    /// A format that the device does not support for a usage.
    #[error("SG0605: `{resource}` has the format {format:?}, which this device {problem}")]
    FormatSupport { resource: String, format: crate::Format, problem: String },
    /// A wgpu validation error in what passes record, found by `Compiled::execute_checked`.
    #[error("SG0606: wgpu validation error in {passes}: {message}")]
    Validation { passes: String, message: String },
    /// The device is out of memory for a texture or buffer.
    #[error(
        "SG0607: out of device memory for `{resource}` ({bytes} bytes); make it smaller, or release \
         something else (the graph has released what it had cached)"
    )]
    OutOfMemory { resource: String, bytes: u64 },
    /// The device is lost.
    #[error(
        "SG0608: the device is lost; create another one, and recreate the graph and everything else on it"
    )]
    DeviceLost,
}

impl Error {
    /// Creates an error for a failure inside a pass body; the executor adds the name of the pass.
    pub fn body(message: impl std::fmt::Display) -> Self {
        Self::Body { pass: PassName::default(), message: message.to_string() }
    }

    /// Returns the error's code, such as `SG0101`. A code is never reused for another error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::StaleRead { .. } => "SG0101",
            Self::TwoWriters { .. } => "SG0102",
            Self::ForeignHandle { .. } => "SG0103",
            Self::Undeclared { .. } => "SG0104",
            Self::UndefinedRead { .. } => "SG0201",
            Self::UndefinedPreserve { .. } => "SG0202",
            Self::Conflict { .. } => "SG0203",
            Self::PreviousWritten { .. } => "SG0204",
            Self::NoAttachment { .. } => "SG0301",
            Self::AttachmentMismatch { .. } => "SG0302",
            Self::AttachmentSubresource { .. } => "SG0303",
            Self::Format { .. } => "SG0304",
            Self::Clear { .. } => "SG0305",
            Self::Resolve { .. } => "SG0306",
            Self::SecondDepth { .. } => "SG0307",
            Self::CopyMismatch { .. } => "SG0308",
            Self::InvalidResource { .. } => "SG0401",
            Self::InvalidSubresource { .. } => "SG0402",
            Self::ImportUsage { .. } => "SG0403",
            Self::NoImport { .. } => "SG0404",
            Self::Order { .. } => "SG0501",
            Self::NotPublished { .. } => "SG0502",
            Self::Limit { .. } => "SG0601",
            Self::Body { .. } => "SG0602",
            Self::ReadBack { .. } => "SG0603",
            Self::Shader { .. } => "SG0604",
            Self::FormatSupport { .. } => "SG0605",
            Self::Validation { .. } => "SG0606",
            Self::OutOfMemory { .. } => "SG0607",
            Self::DeviceLost => "SG0608",
        }
    }
}
