//! What can be wrong with a frame. Every message names the pass, the resource and the way out.

/// A mistake in a frame's declaration, or a limit of the device that it runs into.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the fields are the names in the message above them")]
pub enum Error {
    /// A handle that a write left behind was read.
    #[error(
        "pass `{pass}` reads version {version} of `{resource}`, but `{writer}` has since written version {latest}: \
         read before that write, or use the handle that was passed to it by `&mut`"
    )]
    StaleRead { pass: String, resource: String, version: u32, writer: String, latest: u32 },
    /// Two passes write the same version.
    #[error(
        "pass `{pass}` writes version {version} of `{resource}`, which `{writer}` has already written over: pass the \
         same handle by `&mut` to both, not a clone made before the first write"
    )]
    TwoWriters { pass: String, resource: String, version: u32, writer: String },
    /// Nothing has defined what is read.
    #[error(
        "pass `{pass}` reads `{resource}`, whose contents are undefined: write it in an earlier pass (clear or cover), \
         or import it as defined"
    )]
    UndefinedRead { pass: String, resource: String },
    /// A preserving write over undefined contents.
    #[error(
        "pass `{pass}` preserves `{resource}`, whose contents are undefined: use `Contents::Clear` or \
         `Contents::Cover` for the first write"
    )]
    UndefinedPreserve { pass: String, resource: String },
    /// A token was used in a pass that did not declare the access.
    #[error(
        "pass `{pass}` touches `{resource}` without having declared it (the token belongs to `{declared_by}`): declare \
         the access on `{pass}` and use the token it returns"
    )]
    Undeclared { pass: String, resource: String, declared_by: String },
    /// A handle or token of another frame.
    #[error(
        "{place} uses a handle of another frame: handles live for one frame, import the resource instead"
    )]
    ForeignHandle { place: String },
    /// One pass touches a resource in two ways that exclude each other.
    #[error(
        "pass `{pass}` touches `{resource}` as {first} and as {second}, which no GPU allows in one pass: split the \
         pass, or write to another texture"
    )]
    Conflict { pass: String, resource: String, first: &'static str, second: &'static str },
    /// A render pass without an attachment.
    #[error(
        "render pass `{pass}` has no attachment: give it a colour or depth target, or make it a compute pass"
    )]
    NoAttachment { pass: String },
    /// Attachments that differ in size or sample count.
    #[error(
        "the attachments of pass `{pass}` differ: {first}, {second}; give them the same size and sample count"
    )]
    AttachmentMismatch { pass: String, first: String, second: String },
    /// A format that cannot be used so.
    #[error("pass `{pass}` uses `{resource}` as {access}, but its format {format:?} {problem}")]
    Format {
        pass: String,
        resource: String,
        access: &'static str,
        format: crate::Format,
        problem: &'static str,
    },
    /// A clear value that does not fit.
    #[error("pass `{pass}` clears `{resource}` with {problem}")]
    Clear { pass: String, resource: String, problem: &'static str },
    /// Colour attachment indices with a gap or used twice.
    #[error("pass `{pass}`: colour attachment {index} is given twice")]
    ColorIndex { pass: String, index: u32 },
    /// An imported resource lacks a usage.
    #[error(
        "pass `{pass}` uses imported `{resource}` as {access}, but it was created without {needed}: add that usage \
         where you create it"
    )]
    ImportUsage { pass: String, resource: String, access: &'static str, needed: String },
    /// An import was declared without an object.
    #[error(
        "`{resource}` was declared as an import, but nothing was imported: use `import_texture` or `import_buffer`"
    )]
    NoImport { resource: String },
    /// A texture without extent.
    #[error("`{resource}` has no size in at least one direction: every side must be 1 or more")]
    EmptyResource { resource: String },
    /// Two ends of a copy do not fit.
    #[error("copy pass `{pass}`: {from} does not fit {to}; sizes and formats must agree")]
    CopyMismatch { pass: String, from: String, to: String },
    /// A resource is larger than the device allows.
    #[error("`{resource}` needs {needed} ({limit}), but this device allows {allowed}: ask for a smaller one")]
    Limit { resource: String, limit: &'static str, needed: u64, allowed: u64 },
    /// A pass body failed.
    #[error("pass `{pass}`: {message}")]
    Body { pass: String, message: String },
}

impl Error {
    /// Wraps a failure of your own inside a pass body; the executor adds the pass's name.
    pub fn body(message: impl std::fmt::Display) -> Self {
        Self::Body { pass: String::new(), message: message.to_string() }
    }
}
