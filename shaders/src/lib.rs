//! The WGSL of Shadowgraph by import path, and its composition.
//!
//! A WGSL file is either a *module*, which names its import path (`#define_import_path shadowgraph::view`) and
//! is imported by others (`#import shadowgraph::view::{view, lights}`), or an *entry file* with entry points.
//! [`compose`] composes a built-in entry file with everything that it imports, [`compose_source`] a file of the caller.
//! The result is a validated [`naga::Module`] (for wgpu, `ShaderSource::Naga`).
//!
//! The caller passes the module `shadowgraph::technique`: [`MAPPED`], [`RAYTRACED`], [`NONE`] or that of another technique.
//! It defines `shadow_visibility` and `shadow_debug_color`; `shadows/none.wgsl` shows their signatures.
//!
//! ```
//! use shadowgraph_shaders::{NONE, compose};
//!
//! let module = compose("forward.wgsl", &[NONE])?;
//! assert!(module.entry_points.iter().any(|entry| entry.name == "fs_forward"));
//! # Ok::<(), shadowgraph_shaders::Error>(())
//! ```
//!
//! Names that a module exports (also of struct members) must not end in a digit or contain two underscores in a row: naga
//! changes the ending of such names when it writes them for importing modules.

mod cache;
mod compose;
mod error;
mod folder;
mod imports;
pub mod layout;
mod report;
mod source;

pub use compose::{compose, compose_source};
pub use error::Error;
pub use folder::set_folder;
pub use naga;
pub use source::{
    CLUSTERED, EVSM, FEW_LIGHTS, FEW_VIEWS, MAPPED, MAPPED_EXPLANATION, MASK_ONLY, MOMENTS, MSM,
    ModuleSource, NONE, OCCLUDED, PAGE_EXPLANATION, PAGE_PENUMBRA, PAGE_POOL, PCF_FILTER, PCSS, PREFILTER,
    RAYTRACED, SCREEN, SKY_LIGHT, TRACED_EXPLANATION, VIRTUAL, builtin, builtin_files,
};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
