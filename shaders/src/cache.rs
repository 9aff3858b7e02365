//! Composed modules, kept for the whole program: renderers compose the same files again and again.

use crate::source::ModuleSource;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// An entry file and the modules passed with it. The built-in modules never change, so a composition depends on nothing else.
pub(crate) type Key = (ModuleSource, Vec<ModuleSource>);

/// The largest number of modules that are kept: more than the built-in files have variants.
const MAX_MODULES: usize = 256;

static MODULES: LazyLock<Mutex<HashMap<Key, Arc<naga::Module>>>> = LazyLock::new(Mutex::default);

/// Returns the module that was composed from these sources.
pub(crate) fn find(key: &Key) -> Option<naga::Module> {
    let module = MODULES.lock().unwrap_or_else(PoisonError::into_inner).get(key).cloned();
    // Cloned without holding the lock.
    module.map(Arc::unwrap_or_clone)
}

/// Keeps a composed module. A program that keeps composing changed sources starts over when the cache is full.
pub(crate) fn insert(key: Key, module: &naga::Module) {
    let mut modules = MODULES.lock().unwrap_or_else(PoisonError::into_inner);
    if modules.len() >= MAX_MODULES {
        modules.clear();
    }
    modules.insert(key, Arc::new(module.clone()));
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::compose_source;

    #[test]
    fn a_composed_module_is_found_again_and_that_of_a_changed_file_is_not() {
        let entry = |value: f32| {
            let text = format!("@fragment fn fs() -> @location(0) vec4f {{ return vec4f({value:?}); }}");
            ModuleSource::new("cache_test.wgsl", text)
        };
        assert!(find(&(entry(1.0), Vec::new())).is_none());
        let module = compose_source(&entry(1.0), &[]).unwrap();
        let kept = find(&(entry(1.0), Vec::new())).unwrap();
        assert_eq!(format!("{module:?}"), format!("{kept:?}"));
        assert!(find(&(entry(2.0), Vec::new())).is_none());
    }
}
