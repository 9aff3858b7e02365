//! The WGSL files that come with the crate.

use std::borrow::Cow;

/// A WGSL file: its name, for messages, and its source.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct ModuleSource {
    /// The name in error messages, such as a path.
    pub file: Cow<'static, str>,
    /// The WGSL source. A module has a line `#define_import_path a::b`; an entry file needs none.
    pub source: Cow<'static, str>,
}

impl ModuleSource {
    /// Creates a source from a name for messages and its WGSL.
    pub fn new(file: impl Into<Cow<'static, str>>, source: impl Into<Cow<'static, str>>) -> Self {
        Self { file: file.into(), source: source.into() }
    }
}

/// A file under `wgsl/`.
macro_rules! file {
    ($file:literal) => {
        ModuleSource {
            file: Cow::Borrowed($file),
            source: Cow::Borrowed(include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/wgsl/", $file))),
        }
    };
}

/// The technique `none`: no shadows, no bindings.
pub const NONE: ModuleSource = file!("shadows/none.wgsl");

/// The module of shadow map techniques: it finds the tiles that a point is read from, and evaluates the functions `filtered` and
/// `filter_radius` of the module `shadowgraph::shadows::filter`: unless the caller passes another one, that of `pcf`.
pub const MAPPED: ModuleSource = file!("shadows/mapped.wgsl");

/// The shadow views and lights of a frame with few of them, as uniform blocks; it replaces the built-in module that reads storage
/// buffers.
pub const FEW_VIEWS: ModuleSource = file!("shadows/few_views.wgsl");

/// The filter of the technique `pcss`, for [`MAPPED`].
pub const PCSS: ModuleSource = file!("shadows/pcss.wgsl");

/// The filter of techniques with moment maps, for [`MAPPED`]; the module `shadowgraph::shadows::encoding` defines the
/// moments.
pub const MOMENTS: ModuleSource = file!("shadows/moments.wgsl");

/// The moments of the technique `evsm`, for [`MOMENTS`].
pub const EVSM: ModuleSource = file!("shadows/evsm.wgsl");

/// The moments of the technique `msm`, for [`MOMENTS`].
pub const MSM: ModuleSource = file!("shadows/msm.wgsl");

/// The passes that create moment maps, for [`EVSM`] or [`MSM`]: replace `FORMAT` by the texel format.
pub const PREFILTER: ModuleSource = file!("prefilter.wgsl");

/// The technique `screen`: the visibility of another technique for all visible surfaces, in a screen mask. Its bindings follow
/// those of the other technique, whose import path is `shadowgraph::inner`: replace `MASK` and `LAYERS` by their numbers.
pub const SCREEN: ModuleSource = file!("shadows/screen.wgsl");

/// The technique `screen` if only its mask is needed; `MASK` and `LAYERS` are as in [`SCREEN`].
pub const MASK_ONLY: ModuleSource = file!("shadows/mask.wgsl");

/// The lights of a point's cluster; it replaces the built-in module that evaluates all lights.
pub const CLUSTERED: ModuleSource = file!("clustered.wgsl");

/// The lights of a frame with few of them, as a uniform block; it replaces the built-in module that reads a storage buffer. Replace
/// `ONLY_SUN: bool = false` if there is exactly one, a directional one.
pub const FEW_LIGHTS: ModuleSource = file!("few_lights.wgsl");

/// Screen-space ambient occlusion for lit passes; it replaces the built-in module without occlusion. Replace `OCCLUSION` by the
/// number of its binding in group 0.
pub const OCCLUDED: ModuleSource = file!("occluded.wgsl");

/// The light of a sky, and the background; it replaces the built-in module of a colour from above and one from below. Replace
/// `ENVIRONMENT` by the number of its binding in group 0.
pub const SKY_LIGHT: ModuleSource = file!("sky_light.wgsl");

/// What [`MAPPED`] says about a point; it replaces the built-in module `shadowgraph::explanation`, which says nothing.
pub const MAPPED_EXPLANATION: ModuleSource = file!("shadows/mapped_explanation.wgsl");

/// What [`VIRTUAL`] says about a point, as [`MAPPED_EXPLANATION`].
pub const PAGE_EXPLANATION: ModuleSource = file!("shadows/page_explanation.wgsl");

/// What [`RAYTRACED`] says about a point, as [`MAPPED_EXPLANATION`].
pub const TRACED_EXPLANATION: ModuleSource = file!("shadows/traced_explanation.wgsl");

/// The technique `raytraced`: hard shadows by rays through the scene's triangles.
pub const RAYTRACED: ModuleSource = file!("shadows/raytraced.wgsl");

/// The technique `virtual`: shadows from pages of virtual shadow maps, for [`PAGE_POOL`] and [`PCF_FILTER`].
pub const VIRTUAL: ModuleSource = file!("shadows/virtual.wgsl");

/// The pool of pages of [`VIRTUAL`]; it replaces the built-in module of the maps of cascades and the atlas.
pub const PAGE_POOL: ModuleSource = file!("shadows/page_pool.wgsl");

/// The filter radii of [`VIRTUAL`] for lights with penumbrae; it replaces the built-in module of constant radii.
pub const PAGE_PENUMBRA: ModuleSource = file!("shadows/page_penumbra.wgsl");

/// The filter of the technique `pcf`. Its sampler is binding 10.
pub const PCF_FILTER: ModuleSource = file!("shadows/pcf.wgsl");

/// The modules that any file can import.
pub(crate) const MODULES: &[ModuleSource] = &[
    file!("cluster_grid.wgsl"),
    file!("cull_boxes.wgsl"),
    file!("draw.wgsl"),
    file!("environment.wgsl"),
    file!("exposure_bins.wgsl"),
    file!("float_order.wgsl"),
    file!("frame_noise.wgsl"),
    file!("fullscreen.wgsl"),
    file!("gbuffer_layout.wgsl"),
    file!("ground_depth.wgsl"),
    file!("layer_views.wgsl"),
    file!("light.wgsl"),
    file!("light_list.wgsl"),
    file!("lighting.wgsl"),
    file!("lights.wgsl"),
    file!("material.wgsl"),
    file!("material_features.wgsl"),
    file!("mesh.wgsl"),
    file!("noise.wgsl"),
    file!("occluders.wgsl"),
    file!("pages_state.wgsl"),
    file!("ray_surfaces.wgsl"),
    file!("rays.wgsl"),
    file!("receiver.wgsl"),
    file!("screen_occlusion.wgsl"),
    file!("shade.wgsl"),
    file!("shadows/colors.wgsl"),
    file!("shadows/cube.wgsl"),
    file!("shadows/evsm_layout.wgsl"),
    file!("shadows/explained_lookup.wgsl"),
    file!("shadows/explanation.wgsl"),
    file!("shadows/footprint.wgsl"),
    file!("shadows/layers.wgsl"),
    file!("shadows/linear_depth.wgsl"),
    file!("shadows/lookup.wgsl"),
    file!("shadows/maps.wgsl"),
    file!("shadows/page_filter.wgsl"),
    file!("shadows/page_blockers.wgsl"),
    file!("shadows/page_depths.wgsl"),
    file!("shadows/page_lookup.wgsl"),
    file!("shadows/pages.wgsl"),
    PCF_FILTER,
    file!("shadows/raytraced_settings.wgsl"),
    file!("shadows/tent.wgsl"),
    file!("shadows/crease.wgsl"),
    file!("shadows/tiles.wgsl"),
    file!("shadows/tints.wgsl"),
    file!("shadows/traced.wgsl"),
    file!("shadows/types.wgsl"),
    file!("shadows/variant.wgsl"),
    file!("shadows/views.wgsl"),
    file!("surface.wgsl"),
    file!("tint_density.wgsl"),
    file!("view.wgsl"),
];

/// The built-in modules with the import path [`TECHNIQUE`], of which the caller passes one.
pub(crate) const TECHNIQUES: &[ModuleSource] = &[NONE, MAPPED, RAYTRACED, VIRTUAL];

// The files with entry points, `ENTRIES`: `build.rs` lists all files that are not modules.
include!(concat!(env!("OUT_DIR"), "/entries.rs"));

/// The import path of every shadow technique's module.
pub(crate) const TECHNIQUE: &str = "shadowgraph::technique";

/// Returns a built-in WGSL file by its name, such as `"shadows/none.wgsl"`.
#[must_use]
pub fn builtin(file: &str) -> Option<ModuleSource> {
    all().find(|module| module.file == file).cloned()
}

/// Returns the names of the built-in WGSL files: modules, techniques and entry files, each sorted by name.
pub fn builtin_files() -> impl Iterator<Item = &'static str> {
    all().map(|module| module.file.as_ref())
}

/// Joins the names of some files with commas.
pub(crate) fn names(files: &[ModuleSource]) -> String {
    files.iter().map(|module| module.file.as_ref()).collect::<Vec<_>>().join(", ")
}

fn all() -> impl Iterator<Item = &'static ModuleSource> {
    MODULES.iter().chain(TECHNIQUES).chain(ENTRIES)
}
