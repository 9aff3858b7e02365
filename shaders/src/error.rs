//! Errors in WGSL and its composition.

/// An error of composing WGSL, or of comparing struct layouts.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// No built-in entry file has this name.
    #[error("unknown built-in entry file `{file}`; expected one of: {known}")]
    UnknownFile {
        /// The requested file.
        file: String,
        /// The existing names.
        known: String,
    },
    /// An import of an unknown module.
    #[error("{file}:{line}: unknown module `{path}`; did you mean one of: {similar}?")]
    UnknownImport {
        /// The importing file.
        file: String,
        /// Its line, from 1.
        line: usize,
        /// The import path that was not found.
        path: String,
        /// The import paths that are most similar.
        similar: String,
    },
    /// The technique's module is imported but was not passed.
    #[error(
        "{file}:{line}: no module was passed for `shadowgraph::technique`: pass the module of a shadow technique; \
         built in are: {known}"
    )]
    NoTechnique {
        /// The importing file.
        file: String,
        /// Its line, from 1.
        line: usize,
        /// The files of the built-in techniques.
        known: String,
    },
    /// A module without an import path.
    #[error("{file}: expected a line `#define_import_path some::path`, which a module needs to be imported")]
    NoImportPath {
        /// The file.
        file: String,
    },
    /// Two of the passed modules have the same import path.
    #[error("duplicate import path `{path}` in {first} and {second}: pass one of them")]
    DuplicateModule {
        /// The path.
        path: String,
        /// The file passed first.
        first: String,
        /// The other one.
        second: String,
    },
    /// Modules import each other in a cycle.
    #[error("cycle of module imports: {cycle}")]
    ImportCycle {
        /// The files of the cycle.
        cycle: String,
    },
    /// Invalid WGSL.
    #[error("{file}:{line}: {message}{}", source_line(text))]
    Wgsl {
        /// The file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The error.
        message: String,
        /// The source of the line.
        text: String,
    },
    /// The module has no struct of this name, or several that differ.
    #[error("expected one struct `{name}`, found {count}; the module's structs: {known}")]
    StructNotFound {
        /// The requested name.
        name: String,
        /// The number of structs of this name.
        count: usize,
        /// The structs of the module.
        known: String,
    },
    /// The struct has another size.
    #[error("WGSL struct `{name}` has {actual} bytes, expected {expected}")]
    StructSize {
        /// The struct.
        name: String,
        /// Bytes in WGSL.
        actual: usize,
        /// Expected bytes.
        expected: usize,
    },
    /// The struct lacks a field.
    #[error("WGSL struct `{name}` has no field `{field}`; its fields: {known}")]
    FieldMissing {
        /// The struct.
        name: String,
        /// The expected field.
        field: String,
        /// The existing fields.
        known: String,
    },
    /// The struct has an additional field.
    #[error("WGSL struct `{name}` has an unexpected field `{field}` at byte {offset}")]
    FieldUnexpected {
        /// The struct.
        name: String,
        /// The field.
        field: String,
        /// Its offset in bytes.
        offset: usize,
    },
    /// A field has another offset.
    #[error("field `{field}` of WGSL struct `{name}` is at byte {actual}, expected {expected}")]
    FieldOffset {
        /// The struct.
        name: String,
        /// The field.
        field: String,
        /// Its offset in WGSL, in bytes.
        actual: usize,
        /// Expected offset in bytes.
        expected: usize,
    },
    /// A field has another type.
    #[error("field `{field}` of WGSL struct `{name}` is {}, expected `{expected}`", type_of(actual))]
    FieldType {
        /// The struct.
        name: String,
        /// The field.
        field: String,
        /// Its type in WGSL; empty if it is not a scalar of four bytes.
        actual: String,
        /// The expected type.
        expected: String,
    },
}

/// Returns a type in words.
fn type_of(actual: &str) -> String {
    if actual.is_empty() { "no scalar".to_owned() } else { format!("of type `{actual}`") }
}

/// Returns the source line on a separate line, if there is one.
fn source_line(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("\n    {text}") }
}
