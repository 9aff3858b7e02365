//! Cascaded and atlas shadow maps as render-graph nodes, and the technique contract.
//!
//! [`plan_shadows`] turns a camera, lights and casters ([`ShadowCasters`]) into a [`ShadowPlan`]: the maps and
//! tiles of a frame, the casters of each, and the structs ([`ShadowView`], [`ShadowLight`]) that shaders read.
//! It is pure maths in f64 and can be used without the nodes.
//!
//! - *Cascades*: up to eight tiles for each of the brightest directional lights, each for a slice of the view frustum.
//! - *Atlas*: tiles for spot and point lights and further directional lights.
//!
//! A [`ShadowTechnique`] adds the passes and the WGSL; [`Techniques`] finds techniques by name, also those of other crates.
//!
//! [`QualityController`] lowers the settings while the passes exceed a time budget.
//!
//! Depth is reversed (1 nearest to the light, 0 farthest, cleared to 0). Directional tiles move through the
//! world in whole texels, so shadows do not flicker when the camera moves.

mod allocation;
mod atlas;
mod budget;
mod cascades;
mod caster_view;
mod casters;
mod cull;
mod culled;
mod error;
mod explained_lookup;
mod gpu_casters;
mod layered_casters;
mod light_params;
mod lookup_variant;
mod maps;
mod ortho;
mod plan;
mod planner;
pub mod rays;
mod receivers;
mod registry;
mod requirements;
mod select;
mod settings;
mod spot;
mod technique;
mod techniques;
mod tile_fit;
mod vertex_buffers;
mod views;

pub use allocation::{AtlasAllocation, AtlasConfig, TileAllocation, TileRequest, allocate_tiles};
pub use atlas::{MAX_ATLAS_TILES, TileLayout, TileRect, even_tiles, smallest_atlas_tile_px};
pub use budget::{BudgetConfig, QualityController, QualityLevel};
pub use cascades::{Slice, slice_sphere, split_distances};
pub use caster_view::{CasterPass, CasterTarget, CasterView, TINT_FORMAT, TileKind, caster_view_layout};
pub use casters::{Mobility, ShadowCasters};
pub use cull::{CoveredByFinerCascade, LightSpaceView, ReceiverHull, RedundantCasters};
pub use culled::{CulledGroup, CulledInstances, CulledTokens};
pub use error::Error;
pub use gpu_casters::{CasterQuery, GpuCasters};
pub use layered_casters::{LayerTokens, LayeredCasters, LayeredInstances, TintTokens};
pub use lookup_variant::{CommonLookup, LookupSource, LookupVariant, MapUse};
pub use maps::{DrawnMap, DrawnMaps, ShadowMaps};
pub use ortho::{OrthoFit, light_from_world};
pub use plan::{MapPlan, PlanState, ShadowInputs, ShadowPlan, TilePlan};
pub use planner::{plan_shadows, plan_shadows_after};
pub use receivers::{ReceiverRange, SkippedSlices, SteppedDistance};
pub use registry::{
    EVSM, MSM, NONE, PCF, PCSS, RAYTRACED, SDSM, Technique, TechniqueContext, TechniqueKind,
    TechniqueModifier, Techniques, VIRTUAL,
};
pub use requirements::Requirements;
pub use select::{Unshadowed, UnshadowedReason};
pub use settings::{
    AtlasSettings, AtlasTiles, BiasMethod, BiasSettings, CascadeBlend, CascadeFitting, CascadeSelection,
    CascadeSettings, CullSettings, DepthFormat, DescribeSettings, DistanceMeasure, LightRef, LightShadows,
    MAX_CASCADE_LIGHTS, MAX_CASCADES, MaterialModes, NamedSettings, NormalBias, ObjectModes, Payload,
    Setting, SettingTrack, SettingTracks, SettingType, SettingValue, SettingZone, ShadowFilter,
    ShadowSettings, SplitScheme, TechniqueSettings, TrackValue, Variant, color, defaults, filter_taps,
    settings_file,
};
pub use spot::{MAX_SPOT_HALF_ANGLE, SpotCone, SpotFit};
pub use technique::{
    CountWarning, EXPLANATION_VALUES, ExplanationValues, GpuData, GpuField, GpuStruct, MAX_MASK_LIGHTS,
    MaskLayers, ShadowBinding, ShadowCounts, ShadowExplanation, ShadowFact, ShadowOutputs, ShadowTechnique,
    ShadowTokens, SurfaceBuffers, add_shadows, binding, shadow_layout,
};
pub use techniques::{
    ContactSettings, Evsm, EvsmMoments, EvsmPrecision, EvsmSettings, Msm, MsmSettings, NoShadows, Pcf, Pcss,
    PcssSettings, Raytraced, RaytracedSettings, ScreenSettings, ScreenShadows, Sdsm, SdsmSettings,
    VirtualMaps, VirtualSettings,
};
pub use tile_fit::TileFit;
pub use vertex_buffers::VertexBuffers;
pub use views::{
    BIAS_GRADIENT, BIAS_PLANE, BIAS_RASTER, BIAS_SLOPE, BLEND_DITHER, BLEND_HARD, BLEND_SOFT, MAP_ATLAS,
    MAP_CASCADES, NOT_A_CASCADE, SELECT_DEPTH, SELECT_FACE, SELECT_MAP, SELECT_SPHERE, ShadowLight,
    ShadowView, TilePlacement,
};

/// Used by the expansion of `declare_settings!`.
#[doc(hidden)]
pub mod __settings {
    pub use crate::settings::{Given, json};

    /// Returns the first variant, as the default of an enum that declares none.
    pub fn first_variant(variants: &[crate::Variant]) -> serde_json::Value {
        variants.first().map(crate::Variant::example).unwrap_or_default()
    }
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
