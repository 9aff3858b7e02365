//! A directory of WGSL files that replace the built-in ones, to edit them while a program runs.

use crate::imports::import_path;
use crate::source::{MODULES, ModuleSource};
use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::{PoisonError, RwLock};

static FOLDER: RwLock<Option<PathBuf>> = RwLock::new(None);

/// Sets the directory whose files replace built-in ones of the same name, such as `forward.wgsl` or `shadows/pcf.wgsl`,
/// whenever shaders are composed from now on, in the whole program; `None` restores the built-in ones. It is meant for tools
/// that show the effect of a change while they run. Files that do not exist there stay built in.
pub fn set_folder(folder: Option<PathBuf>) {
    *FOLDER.write().unwrap_or_else(PoisonError::into_inner) = folder;
}

/// Returns the source from the directory, or the given one.
pub(crate) fn current(module: &ModuleSource) -> ModuleSource {
    read(module).unwrap_or_else(|| module.clone())
}

/// Returns the passed modules, and the built-in ones that the directory replaces, with their sources from the directory.
pub(crate) fn with_folder(extra: &[ModuleSource]) -> Vec<ModuleSource> {
    let mut all: Vec<ModuleSource> = extra.iter().map(current).collect();
    let passed: Vec<_> = extra.iter().filter_map(|module| import_path(module).ok()).collect();
    let changed = MODULES.iter().filter_map(read);
    all.extend(changed.filter(|module| import_path(module).is_ok_and(|path| !passed.contains(&path))));
    all
}

impl ModuleSource {
    /// Returns the file, as [`set_folder`] has it, with a placeholder replaced.
    ///
    /// ```
    /// use shadowgraph_shaders::OCCLUDED;
    /// let module = OCCLUDED.with_value("OCCLUSION", "2");
    /// assert!(module.source.contains("@binding(2)"));
    /// assert_eq!(module.file, "occluded.wgsl (OCCLUSION = 2)");
    /// ```
    #[must_use]
    pub fn with_value(&self, placeholder: &str, value: &str) -> Self {
        let current = current(self);
        let file = format!("{} ({placeholder} = {value})", current.file);
        Self::new(file, current.source.replace(placeholder, value))
    }
}

fn read(module: &ModuleSource) -> Option<ModuleSource> {
    let folder = FOLDER.read().unwrap_or_else(PoisonError::into_inner);
    let source = std::fs::read_to_string(folder.as_ref()?.join(module.file.as_ref())).ok()?;
    Some(ModuleSource { file: module.file.clone(), source: Cow::Owned(source) })
}
