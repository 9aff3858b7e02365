//! What can be wrong with WGSL and its composition.

/// Why WGSL could not be composed, or a struct does not lie in memory as expected.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No built-in entry file has this name.
    #[error("there is no built-in entry file `{file}`; there are: {known}")]
    UnknownFile {
        /// What was asked for.
        file: String,
        /// The names there are.
        known: String,
    },
    /// An import that no module answers.
    #[error("{file}:{line}: no module is called `{path}`; near names: {near}")]
    UnknownImport {
        /// The importing file.
        file: String,
        /// Its line, from 1.
        line: usize,
        /// The import path that was not found.
        path: String,
        /// The import paths that look most like it.
        near: String,
    },
    /// The technique's module is imported but was not passed.
    #[error(
        "{file}:{line}: no shadow technique is given for `shadowgraph::technique`: pass the technique's module \
         along; built in are: {known}"
    )]
    NoTechnique {
        /// The importing file.
        file: String,
        /// Its line, from 1.
        line: usize,
        /// The files of the built-in techniques.
        known: String,
    },
    /// A file that should be imported does not say by which path.
    #[error("{file}: a module needs a line `#define_import_path some::path`, or it cannot be imported")]
    NoImportPath {
        /// The file.
        file: String,
    },
    /// Two of the passed modules have the same import path.
    #[error("{first} and {second} both define the import path `{path}`: pass one of them")]
    DuplicateModule {
        /// The path.
        path: String,
        /// The file passed first.
        first: String,
        /// The other one.
        second: String,
    },
    /// Modules import each other in a circle.
    #[error("modules import each other in a circle: {cycle}")]
    ImportCycle {
        /// The files on the way round.
        cycle: String,
    },
    /// The WGSL itself is wrong.
    #[error("{file}:{line}: {message}{}", below(text))]
    Wgsl {
        /// The file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// What is wrong.
        message: String,
        /// The text of the line.
        text: String,
    },
    /// The module has no struct of this name, or several that differ.
    #[error("{count} structs are called `{name}`, one was expected; the module's structs: {known}")]
    StructNotFound {
        /// What was asked for.
        name: String,
        /// How many there are.
        count: usize,
        /// The structs there are.
        known: String,
    },
    /// The struct has another size.
    #[error("WGSL struct `{name}` takes {actual} bytes, not {expected}")]
    StructSize {
        /// The struct.
        name: String,
        /// Bytes in WGSL.
        actual: usize,
        /// Bytes that were expected.
        expected: usize,
    },
    /// The struct lacks a field.
    #[error("WGSL struct `{name}` has no field `{field}`; it has: {known}")]
    FieldMissing {
        /// The struct.
        name: String,
        /// The field that was expected.
        field: String,
        /// The fields there are.
        known: String,
    },
    /// The struct has a field more.
    #[error("WGSL struct `{name}` also has a field `{field}` at byte {offset}, which was not expected")]
    FieldUnexpected {
        /// The struct.
        name: String,
        /// The field.
        field: String,
        /// Its place in bytes.
        offset: usize,
    },
    /// A field is elsewhere.
    #[error("field `{field}` of WGSL struct `{name}` is at byte {actual}, not {expected}")]
    FieldOffset {
        /// The struct.
        name: String,
        /// The field.
        field: String,
        /// Its place in WGSL, bytes.
        actual: usize,
        /// The place that was expected, bytes.
        expected: usize,
    },
}

/// A line of its own for a source text, where there is any.
fn below(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("\n    {text}") }
}
