//! What can be wrong with a frame. Every message names the pass, the resource and the way out.

/// A mistake in a frame's declaration, or a limit of the device that it runs into.
///
/// Each has a [`code`](Self::code) that never changes and begins its message; `docs/errors.md` has a section with
/// an example for each.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the fields are the names in the message above them")]
pub enum Error {
    /// A handle that a write left behind was read.
    #[error(
        "SG0101: {place} reads version {version} of `{resource}`, but `{writer}` has since written version \
         {latest}: read before that write, or use the handle that was passed to it by `&mut` (export last)"
    )]
    StaleRead { place: String, resource: String, version: u32, writer: String, latest: u32 },
    /// Two passes write the same version.
    #[error(
        "SG0102: pass `{pass}` writes version {version} of `{resource}`, which `{writer}` has already \
         written over: pass the same handle by `&mut` to both, not a clone made before the first write"
    )]
    TwoWriters { pass: String, resource: String, version: u32, writer: String },
    /// A handle or token of another frame.
    #[error(
        "SG0103: {place} uses a handle of another frame: handles live for one frame, so keep \
         contents by a history, or import what is yours"
    )]
    ForeignHandle { place: String },
    /// A token was used in a pass that did not declare the access.
    #[error(
        "SG0104: pass `{pass}` touches `{resource}` without having declared it (the token belongs to \
         `{declared_by}`): declare the access on `{pass}` and use the token it returns"
    )]
    Undeclared { pass: String, resource: String, declared_by: String },
    /// Nothing has defined what is read.
    #[error(
        "SG0201: {place} reads {subresource} of `{resource}`, whose contents are undefined, at least in part: \
         write all of it in earlier passes (clear or cover), or import it as defined"
    )]
    UndefinedRead { place: String, resource: String, subresource: String },
    /// A preserving write over undefined contents.
    #[error(
        "SG0202: pass `{pass}` preserves {subresource} of `{resource}`, whose contents are undefined, at least in \
         part: use `Contents::Clear` or `Contents::Overwrite` for the first write"
    )]
    UndefinedPreserve { pass: String, resource: String, subresource: String },
    /// One pass touches a resource in two ways that exclude each other.
    #[error(
        "SG0203: pass `{pass}` touches `{resource}` as {first} and as {second}, which one pass cannot do: \
         split it, or write to another texture, buffer, mip or layer"
    )]
    Conflict { pass: String, resource: String, first: String, second: String },
    /// What a history held in the frame before is written.
    #[error(
        "SG0204: pass `{pass}` writes `{resource}`, which is what a history held in the frame before: \
         write the history's `current` instead"
    )]
    PreviousWritten { pass: String, resource: String },
    /// A render pass without an attachment.
    #[error(
        "SG0301: render pass `{pass}` has no attachment: give it a colour or depth target, or make it a \
         compute pass"
    )]
    NoAttachment { pass: String },
    /// Attachments that differ in size or sample count.
    #[error(
        "SG0302: the attachments of pass `{pass}` differ: {first}, {second}; give them the same size and \
         sample count"
    )]
    AttachmentMismatch { pass: String, first: String, second: String },
    /// An attachment of more than one mip or layer.
    #[error(
        "SG0303: pass `{pass}` attaches {subresource} of `{resource}`, but an attachment is one mip of one layer: \
         narrow it with `subresource(Subresource::FULL.mip(..).layer(..))`"
    )]
    AttachmentSubresource { pass: String, resource: String, subresource: String },
    /// A format that cannot be used so.
    #[error("SG0304: pass `{pass}` uses `{resource}` as {access}, but its format {format:?} {problem}")]
    Format {
        pass: String,
        resource: String,
        access: &'static str,
        format: crate::Format,
        problem: &'static str,
    },
    /// A clear value that does not fit.
    #[error("SG0305: pass `{pass}` clears `{resource}` with {problem}")]
    Clear { pass: String, resource: String, problem: &'static str },
    /// A resolve that cannot be.
    #[error("SG0306: pass `{pass}` resolves into `{resource}`, but {problem}")]
    Resolve { pass: String, resource: String, problem: String },
    /// A second depth attachment.
    #[error(
        "SG0307: pass `{pass}` has the depth attachments `{first}` and `{second}`, but a render pass has \
         one: split it in two"
    )]
    SecondDepth { pass: String, first: String, second: String },
    /// Two ends of a copy do not fit.
    #[error("SG0308: pass `{pass}` cannot copy {from} to {to}: {problem}")]
    CopyMismatch { pass: String, from: String, to: String, problem: String },
    /// A texture or buffer that cannot be.
    #[error("SG0401: `{resource}` cannot be: {problem}")]
    InvalidResource { resource: String, problem: String },
    /// A part that the resource does not have.
    #[error("SG0402: pass `{pass}` touches {subresource} of `{resource}`, but {problem}")]
    InvalidSubresource { pass: String, resource: String, subresource: String, problem: &'static str },
    /// An imported resource lacks a usage.
    #[error(
        "SG0403: pass `{pass}` uses imported `{resource}` as {access}, but it was created without \
         {needed}: add that usage where you create it"
    )]
    ImportUsage { pass: String, resource: String, access: &'static str, needed: String },
    /// An import was declared without an object.
    #[error(
        "SG0404: `{resource}` was declared as an import, but nothing was imported: use `import_texture` or \
         `import_buffer`"
    )]
    NoImport { resource: String },
    /// An order that cannot be.
    #[error(
        "SG0501: pass `{pass}` is to run after pass {other}, which is not declared before it: take the id \
         of an earlier pass"
    )]
    Order { pass: String, other: u32 },
    /// A value that no node published.
    #[error(
        "SG0502: {place} looks up `{value}`, which no node before it has published: add the node that \
         does, or move it before this one"
    )]
    NotPublished { place: String, value: &'static str },
    /// A resource is larger than the device allows.
    #[error(
        "SG0601: `{resource}` needs {needed} ({limit}), but this device allows {allowed}: make it smaller, \
         or request the device with a higher limit"
    )]
    Limit { resource: String, limit: &'static str, needed: u64, allowed: u64 },
    /// A pass body failed.
    #[error("SG0602: pass `{pass}`: {message}")]
    Body { pass: String, message: String },
    /// Something cannot be read back.
    #[error("SG0603: `{resource}` cannot be read back: {problem}")]
    ReadBack { resource: String, problem: String },
    /// A shader that does not compile, or does not fit what it is used for.
    #[error(
        "SG0604: shader `{shader}` does not compile, or does not fit its pass; mend the one or the other: {message}"
    )]
    Shader { shader: String, message: String },
    /// A texture is used in a way that the device does not allow for its format.
    #[error("SG0605: `{resource}` has the format {format:?}, which this device {problem}")]
    FormatSupport { resource: String, format: crate::Format, problem: String },
    /// wgpu objects to what passes record; found by `Compiled::execute_checked`.
    #[error("SG0606: wgpu refuses what {passes} records: {message}")]
    Validation { passes: String, message: String },
    /// The device has no memory left for a texture or buffer.
    #[error(
        "SG0607: there is no memory left on the device for `{resource}` ({bytes} bytes): make it smaller, or let go of \
         something else; the graph has let go of what it kept"
    )]
    OutOfMemory { resource: String, bytes: u64 },
    /// The device is lost.
    #[error("SG0608: the device is lost: open another, and make the graph and all else that was on it anew")]
    DeviceLost,
    /// Neither a pass nor a resource has the name.
    #[error("SG0701: the frame has no pass and no resource `{name}`{hint}")]
    UnknownName { name: String, hint: String },
    /// A text is no dump of a plan, or one that is not read any more.
    #[error("SG0702: not a dump: {problem}")]
    Dump { problem: String },
}

impl Error {
    /// Wraps a failure of your own inside a pass body; the executor adds the pass's name.
    pub fn body(message: impl std::fmt::Display) -> Self {
        Self::Body { pass: String::new(), message: message.to_string() }
    }

    /// Returns the error's code, such as `SG0101`. Codes are never given to another error.
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
            Self::UnknownName { .. } => "SG0701",
            Self::Dump { .. } => "SG0702",
        }
    }
}

/// The page of examples: each of its blocks is compiled and run. Some need a device.
#[cfg(all(doctest, feature = "gpu"))]
#[doc = include_str!("../../../docs/errors.md")]
struct ErrorsPage;
