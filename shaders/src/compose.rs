//! Composes files into one module.

use naga::valid::Capabilities;
use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor};

use crate::cache;
use crate::error::Error;
use crate::folder;
use crate::imports::Library;
use crate::report::wgsl_error;
use crate::source::{ENTRIES, ModuleSource, names};
use std::sync::{Mutex, PoisonError};

/// Composers without modules: creating one compiles many regular expressions, which takes longer than composing a file.
static IDLE: Mutex<Vec<Composer>> = Mutex::new(Vec::new());

/// Composes a built-in entry file, such as `"forward.wgsl"`, with the modules that it imports. `extra` adds
/// modules, such as the shadow technique's, or replaces built-in ones with the same import path.
///
/// # Errors
///
/// No entry file has that name, an import is not found, or the WGSL is invalid; the message names file and line.
pub fn compose(entry_file: &str, extra: &[ModuleSource]) -> Result<naga::Module, Error> {
    match ENTRIES.iter().find(|entry| entry.file == entry_file) {
        Some(entry) => compose_source(entry, extra),
        None => Err(Error::UnknownFile { file: entry_file.to_owned(), known: names(ENTRIES) }),
    }
}

/// Composes an entry file of the caller with the modules that it imports: the built-in ones and `extra`.
///
/// ```
/// use shadowgraph_shaders::{ModuleSource, compose_source};
///
/// let entry = ModuleSource::new(
///     "fog.wgsl",
///     "#import shadowgraph::view::view
///      @fragment fn fs_fog() -> @location(0) vec4f { return vec4f(view.ambient_sky, 1.0); }",
/// );
/// assert_eq!(compose_source(&entry, &[])?.entry_points.len(), 1);
/// # Ok::<(), shadowgraph_shaders::Error>(())
/// ```
///
/// # Errors
///
/// An import is not found, or the WGSL is invalid; the message names file and line.
pub fn compose_source(entry: &ModuleSource, extra: &[ModuleSource]) -> Result<naga::Module, Error> {
    let key = (folder::current(entry), folder::with_folder(extra));
    if let Some(module) = cache::find(&key) {
        return Ok(module);
    }
    let module = compose_uncached(&key.0, &key.1)?;
    cache::insert(key, &module);
    Ok(module)
}

fn compose_uncached(entry: &ModuleSource, extra: &[ModuleSource]) -> Result<naga::Module, Error> {
    let library = Library::new(extra)?;
    let mut composer = IDLE.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default();
    // Capabilities are checked when a device compiles the module.
    composer.capabilities = Capabilities::all();
    let composed = compose_with(&mut composer, &library, entry);
    composer.module_sets.clear();
    composer.module_index.clear();
    IDLE.lock().unwrap_or_else(PoisonError::into_inner).push(composer);
    composed
}

fn compose_with(
    composer: &mut Composer,
    library: &Library<'_>,
    entry: &ModuleSource,
) -> Result<naga::Module, Error> {
    for path in library.needed_by(entry)? {
        let Some(module) = library.get(&path) else { continue };
        let added = composer.add_composable_module(ComposableModuleDescriptor {
            source: &module.source,
            file_path: &module.file,
            ..Default::default()
        });
        if let Err(error) = added {
            return Err(wgsl_error(&error, composer, library, entry));
        }
    }
    let composed = composer.make_naga_module(NagaModuleDescriptor {
        source: &entry.source,
        file_path: &entry.file,
        ..Default::default()
    });
    composed.map_err(|error| wgsl_error(&error, composer, library, entry))
}
