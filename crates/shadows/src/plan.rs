//! The plan of a frame's shadows: the maps, their tiles, the casters of each tile, and the structs
//! that shaders read.

use std::collections::BTreeSet;

use glam::DVec3;
use shadowgraph_scene::{Camera, CullVolume, Light};

use crate::allocation::AtlasAllocation;
use crate::atlas::TileRect;
use crate::caster_view::{CasterPass, CasterTarget, CasterView, TileKind};
use crate::casters::ShadowCasters;
use crate::light_params::settings_requirements;
use crate::lookup_variant::{FEW_LIGHTS, FEW_VIEWS, LookupVariant};
use crate::receivers::ReceiverRange;
use crate::requirements::Requirements;
use crate::select::Unshadowed;
use crate::settings::{DepthFormat, ShadowSettings};
use crate::tile_fit::TileFit;
use crate::views::{ShadowLight, ShadowView};

/// The inputs of a shadow plan.
#[derive(Clone, Copy)]
pub struct ShadowInputs<'a> {
    /// Index of the view, for frames with several views: state that is kept from frame to frame is kept per view.
    pub view: u32,
    /// The camera of the view.
    pub camera: &'a Camera,
    /// The image's width over its height.
    pub aspect: f64,
    /// All lights of the scene; lights without `casts_shadow` are ignored.
    pub lights: &'a [Light],
    /// The casters of the scene.
    pub casters: &'a dyn ShadowCasters,
    /// The point that GPU space is relative to (see [`shadowgraph_scene::origin_near`]).
    pub origin_world: DVec3,
    /// The user's settings.
    pub settings: &'a ShadowSettings,
}

/// A frame's shadows. Equal inputs give equal plans.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadowPlan {
    /// The map of the cascades of the brightest directional lights, if there is one.
    pub cascades: Option<MapPlan>,
    /// The map of all other lights, if there is one.
    pub atlas: Option<MapPlan>,
    /// A view for each tile of both maps, the cascades first. Where a light's view is selected by spheres or depths, an empty
    /// view follows its last.
    pub views: Vec<ShadowView>,
    /// One for each light of the scene, in its order.
    pub lights: Vec<ShadowLight>,
    /// The lights with `casts_shadow` that have no shadows in this frame, in the scene's order.
    pub unshadowed: Vec<Unshadowed>,
    /// What the plan of the next frame follows.
    pub state: PlanState,
    /// The requirements that follow from the settings.
    pub requirements: Requirements,
}

/// What a frame hands on to the plan of the next frame of the same view, so that tiles stay as they are where possible.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanState {
    /// The tiles of lights in the atlas.
    pub atlas_allocation: AtlasAllocation,
    /// The distances between which the receivers are. Cascades begin and end there if that is within the shadow distance.
    pub receivers: ReceiverRange,
}

/// A shadow map.
#[derive(Clone, Debug, PartialEq)]
pub struct MapPlan {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// The depth format.
    pub depth: DepthFormat,
    /// Whether its tiles are cached from frame to frame.
    pub cache: bool,
    /// The tiles. At least one of them has casters.
    pub tiles: Vec<TilePlan>,
}

/// A tile of a shadow map.
#[derive(Clone, Debug, PartialEq)]
pub struct TilePlan {
    /// Index of the light in the scene.
    pub light: u32,
    /// Index of its [`ShadowView`] in [`ShadowPlan::views`].
    pub view: u32,
    /// The kind of tile.
    pub kind: TileKind,
    /// Viewport and scissor.
    pub rect: TileRect,
    /// The tile's projection, before passes on the GPU fit it.
    pub fit: TileFit,
    /// The slope-scaled depth bias of its casters; see [`CasterTarget::slope_bias_milli`].
    pub slope_bias_milli: u32,
    /// The opaque casters to draw, as returned by [`ShadowCasters::cull`]. Can be empty: a cleared tile is lit.
    pub casters: Vec<u32>,
    /// The volume whose opaque casters the [GPU finds](crate::GpuCasters), in place of `casters`.
    pub culled: Option<CullVolume>,
    /// The casters that tint.
    pub tints: Vec<u32>,
}

impl TilePlan {
    /// Returns the casters that a pass draws.
    #[must_use]
    pub fn casters_of(&self, pass: CasterPass) -> &[u32] {
        if pass == CasterPass::Depth { &self.casters } else { &self.tints }
    }

    /// Returns the volume whose casters the GPU finds for a pass.
    pub(crate) fn culled_of(&self, pass: CasterPass) -> Option<&CullVolume> {
        self.culled.as_ref().filter(|_| pass == CasterPass::Depth)
    }

    /// Returns whether a pass draws nothing.
    pub(crate) fn is_empty(&self, pass: CasterPass) -> bool {
        self.casters_of(pass).is_empty() && self.culled_of(pass).is_none()
    }

    /// Describes the tile for [`ShadowCasters::draw`].
    #[must_use]
    pub fn caster_view(
        &self,
        view: &ShadowView,
        pass: CasterPass,
        format: wgpu::TextureFormat,
    ) -> CasterView {
        CasterView {
            target: CasterTarget {
                pass,
                format,
                perspective: view.light.w != 0.0,
                slope_bias_milli: self.slope_bias_milli,
            },
            light: self.light,
            kind: self.kind,
            size_px: [self.rect.width, self.rect.height],
            texel_world: view.texel_world,
        }
    }
}

impl ShadowPlan {
    /// Returns the plan of a frame without shadows: no maps, and everything is lit.
    #[must_use]
    pub fn all_lit(light_count: usize, settings: &ShadowSettings) -> Self {
        Self {
            cascades: None,
            atlas: None,
            views: Vec::new(),
            lights: vec![ShadowLight::default(); light_count],
            unshadowed: Vec::new(),
            state: PlanState::default(),
            requirements: settings_requirements(settings),
        }
    }

    /// Returns the main light: the most important one with cascades, else the first in the atlas. `None` if no light has
    /// shadows.
    #[must_use]
    pub fn main_light(&self) -> Option<u32> {
        let mut tiles = self.cascades.iter().chain(&self.atlas).flat_map(|map| &map.tiles);
        tiles.next().map(|tile| tile.light)
    }

    /// Returns the lights with tiles that translucent casters are drawn into, ascending.
    #[must_use]
    pub fn colored_lights(&self) -> Vec<u32> {
        let tiles = self.cascades.iter().chain(&self.atlas).flat_map(|map| &map.tiles);
        let colored: BTreeSet<u32> =
            tiles.filter(|tile| !tile.tints.is_empty()).map(|tile| tile.light).collect();
        colored.into_iter().collect()
    }

    /// Returns the smallest variant of the WGSL that looks shadows up in maps that this frame can use.
    #[must_use]
    pub fn variant(&self) -> LookupVariant {
        LookupVariant::for_frame(&self.lights, &self.views)
    }

    /// Returns the bytes of the buffer of views: at least one, and if the frame's [variant](Self::variant) reads a uniform
    /// block, those of the block.
    #[must_use]
    pub fn view_bytes(&self, variant: LookupVariant) -> Vec<u8> {
        padded(&self.views, if variant.reads_uniforms() { FEW_VIEWS } else { 1 })
    }

    /// Returns the bytes of the buffer of lights: at least one, and if the frame's [variant](Self::variant) reads a uniform
    /// block, those of the block.
    #[must_use]
    pub fn light_bytes(&self, variant: LookupVariant) -> Vec<u8> {
        padded(&self.lights, if variant.reads_uniforms() { FEW_LIGHTS } else { 1 })
    }
}

/// Returns the bytes of some elements, with zeros for those up to `least`.
fn padded<T: bytemuck::Pod>(elements: &[T], least: usize) -> Vec<u8> {
    let mut bytes = bytemuck::cast_slice(elements).to_vec();
    bytes.resize(elements.len().max(least) * size_of::<T>(), 0);
    bytes
}
