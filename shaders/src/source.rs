//! The WGSL files that come with the crate.

use std::borrow::Cow;

/// A WGSL file: its name, for messages, and its text.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct ModuleSource {
    /// The name that errors give, such as a path.
    pub file: Cow<'static, str>,
    /// The WGSL text. A module has a line `#define_import_path a::b`; an entry file needs none.
    pub source: Cow<'static, str>,
}

impl ModuleSource {
    /// Makes a source from a name for messages and a text.
    pub fn new(file: impl Into<Cow<'static, str>>, source: impl Into<Cow<'static, str>>) -> Self {
        Self { file: file.into(), source: source.into() }
    }
}

/// A file under `wgsl/`.
macro_rules! file {
    ($file:literal) => {
        ModuleSource {
            file: Cow::Borrowed($file),
            source: Cow::Borrowed(include_str!(concat!("../wgsl/", $file))),
        }
    };
}

/// The technique `none`: no shadows, no bindings.
pub const NONE: ModuleSource = file!("shadows/none.wgsl");

/// The techniques of shadow maps: it finds the tiles that a point is read from. What they say is found by the function
/// `filtered` of the module `shadowgraph::shadows::filter`: unless the caller passes another one, that of `pcf`.
pub const MAPPED: ModuleSource = file!("shadows/mapped.wgsl");

/// The filter of the technique `pcss`, for [`MAPPED`].
pub const PCSS: ModuleSource = file!("shadows/pcss.wgsl");

/// The filter of techniques whose maps hold moments of depth, for [`MAPPED`]; what the moments are is the module
/// `shadowgraph::shadows::encoding`.
pub const MOMENTS: ModuleSource = file!("shadows/moments.wgsl");

/// The moments of the technique `evsm`, for [`MOMENTS`].
pub const EVSM: ModuleSource = file!("shadows/evsm.wgsl");

/// The moments of the technique `msm`, for [`MOMENTS`].
pub const MSM: ModuleSource = file!("shadows/msm.wgsl");

/// The passes that make maps of moments, for [`EVSM`] or [`MSM`]: `FORMAT` stands for that of a texel.
pub const PREFILTER: ModuleSource = file!("prefilter.wgsl");

/// The technique `screen`: what another technique says of all that the picture shows, in a screen mask. Its bindings follow
/// those of the other: `MASK` and `LAYERS` stand for their numbers, and the other's import path is `shadowgraph::collected`.
pub const SCREEN: ModuleSource = file!("shadows/screen.wgsl");

/// The technique `screen` where nothing but its mask is needed; `MASK` and `LAYERS` are as in [`SCREEN`].
pub const MASK_ONLY: ModuleSource = file!("shadows/mask.wgsl");

/// Which lights a point asks, those of its cluster: in the place of the built-in module that asks all of them.
pub const CLUSTERED: ModuleSource = file!("clustered.wgsl");

/// Ambient occlusion of the screen, where lit passes have it: in the place of the built-in module without. `OCCLUSION` stands for the
/// number of its binding in group 0.
pub const OCCLUDED: ModuleSource = file!("occluded.wgsl");

/// The technique `raytraced`: hard shadows by rays through the scene's triangles.
pub const RAYTRACED: ModuleSource = file!("shadows/raytraced.wgsl");

/// The modules that any file can import.
pub(crate) const MODULES: &[ModuleSource] = &[
    file!("cluster_grid.wgsl"),
    file!("draw.wgsl"),
    file!("fullscreen.wgsl"),
    file!("gbuffer_layout.wgsl"),
    file!("light_list.wgsl"),
    file!("lighting.wgsl"),
    file!("material.wgsl"),
    file!("mesh.wgsl"),
    file!("noise.wgsl"),
    file!("ray_surfaces.wgsl"),
    file!("rays.wgsl"),
    file!("receiver.wgsl"),
    file!("screen_occlusion.wgsl"),
    file!("shade.wgsl"),
    file!("shadows/evsm_layout.wgsl"),
    file!("shadows/layers.wgsl"),
    file!("shadows/lookup.wgsl"),
    file!("shadows/maps.wgsl"),
    file!("shadows/moment_params.wgsl"),
    file!("shadows/pcf.wgsl"),
    file!("shadows/tent.wgsl"),
    file!("shadows/tiles.wgsl"),
    file!("shadows/tints.wgsl"),
    file!("shadows/traced.wgsl"),
    file!("shadows/types.wgsl"),
    file!("shadows/variant.wgsl"),
    file!("surface.wgsl"),
    file!("view.wgsl"),
];

/// The modules of which the caller passes one, as all have the import path [`TECHNIQUE`].
pub(crate) const TECHNIQUES: &[ModuleSource] = &[NONE, MAPPED, RAYTRACED];

/// The files with entry points.
pub(crate) const ENTRIES: &[ModuleSource] = &[
    file!("blur.wgsl"),
    file!("check.wgsl"),
    file!("clusters.wgsl"),
    file!("collect.wgsl"),
    file!("contact.wgsl"),
    file!("deferred.wgsl"),
    file!("denoise.wgsl"),
    file!("depth.wgsl"),
    file!("forward.wgsl"),
    file!("gbuffer.wgsl"),
    file!("post/bloom.wgsl"),
    file!("post/bloom_mix.wgsl"),
    file!("post/fog.wgsl"),
    file!("post/fxaa.wgsl"),
    file!("post/occlusion.wgsl"),
    file!("post/occlusion_blur.wgsl"),
    file!("post/overlay.wgsl"),
    file!("post/pyramid.wgsl"),
    file!("post/pyramid_halve.wgsl"),
    file!("post/sky.wgsl"),
    file!("post/temporal.wgsl"),
    file!("probe.wgsl"),
    file!("raytrace.wgsl"),
    file!("sdsm.wgsl"),
    file!("show.wgsl"),
    file!("tonemap.wgsl"),
];

/// The import path of every shadow technique's module.
pub(crate) const TECHNIQUE: &str = "shadowgraph::technique";

/// Gives a built-in WGSL file by its name, such as `"shadows/none.wgsl"`.
#[must_use]
pub fn builtin(file: &str) -> Option<ModuleSource> {
    all().find(|module| module.file == file).cloned()
}

/// Lists the names of the built-in WGSL files: modules, techniques, entry files, each by name.
pub fn builtin_files() -> impl Iterator<Item = &'static str> {
    all().map(|module| module.file.as_ref())
}

/// The names of some files, with commas.
pub(crate) fn names(files: &[ModuleSource]) -> String {
    files.iter().map(|module| module.file.as_ref()).collect::<Vec<_>>().join(", ")
}

fn all() -> impl Iterator<Item = &'static ModuleSource> {
    MODULES.iter().chain(TECHNIQUES).chain(ENTRIES)
}
