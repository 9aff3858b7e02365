//! The view and light structs that shaders read: `ShadowView` and `ShadowLight` of `shadowgraph::shadows::types`.

use bytemuck::{Pod, Zeroable};
use glam::{DMat4, DVec2, DVec3, Mat4, Vec2, Vec3, Vec4};
use shadowgraph_scene::BoundingSphere;

use crate::atlas::TileRect;
use crate::cascades::CascadeFit;
use crate::light_params::LightShadowParams;
use crate::ortho::OrthoFit;
use crate::settings::{
    BiasMethod, CascadeBlend, CascadeSelection, DistanceMeasure, MAX_CASCADES, ShadowSettings,
};
use crate::spot::SpotFit;

/// The view of a tile, 256 bytes, the alignment of the dynamic offset with which it is bound for drawing. Shaders also look
/// up shadows with it. World space here is relative to the frame's origin.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ShadowView {
    /// Matrix from world to the tile: x and y -w to w, y up; z/w 1 nearest to the light, 0 farthest.
    pub clip_from_world: Mat4,
    /// Matrix from world to the map: x/w and y/w 0 to 1 over the whole map, y down; z/w as above.
    pub map_from_world: Mat4,
    /// Top left of the tile without its border, texture coordinates of the map.
    pub uv_min: Vec2,
    /// Bottom right of the tile without its border, texture coordinates of the map.
    pub uv_max: Vec2,
    /// The direction to the light (w 0, unit length), or the light's position (w 1).
    pub light: Vec4,
    /// Centre of the sphere that the tile was fitted to.
    pub center: Vec3,
    /// Radius of that sphere, metres.
    pub radius: f32,
    /// Longer side of a texel in the world, metres; for a spot light at 1 m along its axis.
    pub texel_world: f32,
    /// Change of depth over that length towards the light; for a spot light times the distance.
    pub depth_per_texel: f32,
    /// Factor that makes rows 0 and 1 of `clip_from_world`, times `texel_scale`, the light's unit axes.
    pub axis_scale: f32,
    /// Distance between depth 1 and depth 0, metres.
    pub depth_range_m: f32,
    /// Distance from the light to depth 1 along its axis, metres; 0 for a directional light.
    pub near_m: f32,
    /// Index of the cascade; [`NOT_A_CASCADE`] for other tiles.
    pub cascade: u32,
    /// View depth at which the cascade's slice begins, metres; 0 for other tiles.
    pub begin_m: f32,
    /// View depth at which the cascade's slice ends, metres; 0 for other tiles.
    pub end_m: f32,
    /// The tile in the map, pixels: left, top, width, height.
    pub tile_px: [u32; 4],
    /// Factor of the biases.
    pub bias_scale: f32,
    /// Smallest difference of depth that the map can represent.
    pub depth_step: f32,
    /// Offset from a pixel of the map to its texel in the world, modulo 1024: it keeps noise in place while
    /// the tile moves over the world, or is moved in its map.
    pub noise_px: [u32; 2],
    /// 1 if translucent casters are drawn into it and its tints are read, else 0.
    pub is_tinted: u32,
    /// 1 if no caster is beyond depth 0, so points there are looked up too, at depth 0; else 0.
    pub is_open: u32,
    /// Width and height of a texel, as fractions of `texel_world`.
    pub texel_scale: Vec2,
}

/// The views of a light and how they are read, 160 bytes. One for each light of the scene, in its order.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ShadowLight {
    /// Index of its first [`ShadowView`].
    pub first_view: u32,
    /// Number of views; 0 means that everything is lit.
    pub view_count: u32,
    /// The map that contains them: [`MAP_CASCADES`] or [`MAP_ATLAS`].
    pub map: u32,
    /// Method that selects the view of a point: one of `SELECT_*`.
    pub select: u32,
    /// Method that blends adjacent views: one of `BLEND_*`.
    pub blend: u32,
    /// [`ShadowFilter::taps`](crate::ShadowFilter::taps).
    pub filter_taps: u32,
    /// Method that biases lookups towards the light: one of `BIAS_*`.
    pub bias_method: u32,
    /// 1 if the normal bias is scaled by the sine of the angle between normal and light, else 0.
    pub normal_sine: u32,
    /// Strength of its shadows, 0 to 1.
    pub strength: f32,
    /// See [`BiasSettings::normal_texels`](crate::BiasSettings::normal_texels).
    pub normal_bias_texels: f32,
    /// See [`BiasSettings::slope`](crate::BiasSettings::slope).
    pub slope_bias: f32,
    /// See [`BiasSettings::min_slope`](crate::BiasSettings::min_slope).
    pub min_slope: f32,
    /// See [`BiasSettings::max_slope`](crate::BiasSettings::max_slope).
    pub max_slope: f32,
    /// See [`BiasSettings::depth_texels`](crate::BiasSettings::depth_texels).
    pub depth_bias_texels: f32,
    /// Distance at which shadows have faded out, metres.
    pub fade_end_m: f32,
    /// Rate at which they fade before that, per metre.
    pub fade_per_m: f32,
    /// Outer fraction of a view that is blended, 0 to 0.5.
    pub blend_fraction: f32,
    /// Outer fraction of the last view over which shadows fade out, 0 to 1.
    pub edge_fade: f32,
    /// Half the width of the filter's tent at the camera, texels.
    pub filter_half: f32,
    /// Rate at which it shrinks up to `fade_end_m`, texels per metre.
    pub filter_falloff: f32,
    /// 1 if shadows are evaluated at several points of a wide pixel, else 0.
    pub supersample: u32,
    /// 1 if points behind a crease are dark, else 0.
    pub close_creases: u32,
    /// 1 if the distance at which shadows fade is that from the camera, 0 if it is the view depth.
    pub fades_by_radius: u32,
    /// 1 if the view of a point is selected by `ends_m`, else 0.
    pub branch_free: u32,
    /// The camera's position, if `fades_by_radius`.
    pub eye: [f32; 3],
    /// Padding, zero.
    pub padding: u32,
    /// The ends of the cascades, metres of view depth; unused ones are the largest number.
    pub ends_m: [f32; MAX_CASCADES as usize],
    /// Width and height of a texel of the map, texture coordinates; 0 without cascades.
    pub texel_uv: [f32; 2],
    /// 0.
    pub zero: u32,
    /// Padding, zero.
    pub reserved: u32,
}

/// [`ShadowView::cascade`] of a tile that is not a cascade.
pub const NOT_A_CASCADE: u32 = u32::MAX;

/// [`ShadowLight::map`]: the map of the main light's cascades.
pub const MAP_CASCADES: u32 = 0;

/// [`ShadowLight::map`]: the atlas of all other lights.
pub const MAP_ATLAS: u32 = 1;

/// [`ShadowLight::select`]: the first view that covers the point.
pub const SELECT_MAP: u32 = 0;
/// [`ShadowLight::select`]: the first view whose sphere contains the point; an empty view follows the last.
pub const SELECT_SPHERE: u32 = 1;
/// [`ShadowLight::select`]: the view whose slice of view depth contains the point; an empty view follows the last.
pub const SELECT_DEPTH: u32 = 2;
/// [`ShadowLight::select`]: the face of a cube: +X, -X, +Y, -Y, +Z, -Z.
pub const SELECT_FACE: u32 = 3;

/// [`ShadowLight::blend`]: no blending.
pub const BLEND_HARD: u32 = 0;
/// [`ShadowLight::blend`]: two views are interpolated.
pub const BLEND_SOFT: u32 = 1;
/// [`ShadowLight::blend`]: each pixel uses one of two.
pub const BLEND_DITHER: u32 = 2;

/// [`ShadowLight::bias_method`]: along the receiver's plane.
pub const BIAS_PLANE: u32 = 0;
/// [`ShadowLight::bias_method`]: by the receiver's slope.
pub const BIAS_SLOPE: u32 = 1;
/// [`ShadowLight::bias_method`]: by the map's own gradient.
pub const BIAS_GRADIENT: u32 = 2;
/// [`ShadowLight::bias_method`]: the slope of casters as they are drawn.
pub const BIAS_RASTER: u32 = 3;

impl ShadowView {
    /// Returns an empty view: lookups in it are lit.
    #[must_use]
    pub fn empty() -> Self {
        Self { cascade: NOT_A_CASCADE, ..Self::zeroed() }
    }

    /// Creates the view of a directional light's tile.
    #[must_use]
    pub fn directional(fit: &OrthoFit, tile: &TilePlacement, origin_world: DVec3) -> Self {
        let towards_light = fit.light_from_world.transpose().z_axis;
        Self {
            light: towards_light.as_vec3().extend(0.0),
            texel_world: fit.texel_m as f32,
            texel_scale: fit.texel_scale.as_vec2(),
            depth_per_texel: (fit.texel_m / fit.depth_range_m()) as f32,
            axis_scale: fit.half_extent_m() as f32,
            depth_range_m: fit.depth_range_m() as f32,
            noise_px: noise_px(tile, DVec2::new(fit.center_texels.x, -fit.center_texels.y)),
            ..Self::tile(&fit.clip_from_world(origin_world), tile)
        }
        .with_sphere(fit.sphere, origin_world)
    }

    /// Creates the view of a spot light's tile.
    #[must_use]
    pub fn spot(fit: &SpotFit, tile: &TilePlacement, origin_world: DVec3) -> Self {
        let sphere = fit.cone.bounding_sphere();
        Self {
            light: (fit.cone.position_world - origin_world).as_vec3().extend(1.0),
            texel_world: fit.texel_per_m() as f32,
            texel_scale: Vec2::ONE,
            depth_per_texel: (fit.depth_scale_m() * fit.texel_per_m()) as f32,
            axis_scale: fit.tan_half as f32,
            depth_range_m: (fit.far_m - fit.near_m) as f32,
            near_m: fit.near_m as f32,
            noise_px: noise_px(tile, DVec2::ZERO),
            ..Self::tile(&fit.clip_from_world(origin_world), tile)
        }
        .with_sphere(sphere, origin_world)
    }

    fn tile(clip_from_world: &DMat4, tile: &TilePlacement) -> Self {
        let TilePlacement { rect, map_size_px, border_px, depth_step } = *tile;
        let (uv_min, uv_max) = rect.inner_uv(map_size_px, border_px);
        Self {
            clip_from_world: clip_from_world.as_mat4(),
            map_from_world: (rect.map_from_clip(map_size_px) * *clip_from_world).as_mat4(),
            uv_min,
            uv_max,
            cascade: NOT_A_CASCADE,
            tile_px: [rect.x, rect.y, rect.width, rect.height],
            bias_scale: 1.0,
            depth_step,
            ..Self::zeroed()
        }
    }

    fn with_sphere(self, sphere: BoundingSphere, origin_world: DVec3) -> Self {
        let center = (sphere.center_world - origin_world).as_vec3();
        Self { center, radius: sphere.radius_m as f32, ..self }
    }
}

/// Returns [`ShadowView::noise_px`]. `center_texels` is the world's texel at the tile's centre, y down.
fn noise_px(tile: &TilePlacement, center_texels: DVec2) -> [u32; 2] {
    let TileRect { x, y, width, height, .. } = tile.rect;
    let center_px = DVec2::new(f64::from(x + width / 2), f64::from(y + height / 2));
    let offset = (center_texels - center_px).rem_euclid(DVec2::splat(1024.0));
    [offset.x as u32, offset.y as u32]
}

/// The position of a view's tile in its map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TilePlacement {
    /// The tile with its border.
    pub rect: TileRect,
    /// Width and height of the map, pixels.
    pub map_size_px: [u32; 2],
    /// The border, pixels: the radius around a point that is read.
    pub border_px: u32,
    /// See [`DepthFormat::step`](crate::DepthFormat::step).
    pub depth_step: f32,
}

impl ShadowLight {
    /// Creates the struct of a light without views or individual settings. Its shadows fade out before
    /// `distance_m` (above 0) as the settings say.
    #[must_use]
    pub fn new(settings: &ShadowSettings, distance_m: f64) -> Self {
        Self::with_params(&LightShadowParams::new(settings, None, settings.cascades.filter), distance_m)
    }

    pub(crate) fn with_params(params: &LightShadowParams, distance_m: f64) -> Self {
        let half = params.filter.half_width_texels();
        Self {
            filter_taps: params.filter.taps(),
            bias_method: match params.bias.method {
                BiasMethod::Plane => BIAS_PLANE,
                BiasMethod::Slope => BIAS_SLOPE,
                BiasMethod::Gradient => BIAS_GRADIENT,
                BiasMethod::Raster => BIAS_RASTER,
            },
            normal_sine: u32::from(params.normal_sine()),
            strength: params.strength,
            normal_bias_texels: params.normal_texels(),
            slope_bias: params.bias.slope,
            min_slope: params.bias.min_slope,
            max_slope: params.bias.max_slope,
            depth_bias_texels: params.bias.depth_texels,
            fade_end_m: distance_m as f32,
            fade_per_m: (1.0 / (distance_m * f64::from(params.fade_fraction))) as f32,
            filter_half: half as f32,
            supersample: u32::from(params.supersample),
            close_creases: u32::from(params.close_creases),
            fades_by_radius: u32::from(params.measure == DistanceMeasure::Radius),
            ..Self::default()
        }
    }

    /// Adds the parameters of a light with cascades, in a map of `map_size_px`, that end at these view depths.
    pub(crate) fn with_cascades(
        self,
        settings: &crate::CascadeSettings,
        ends: &[CascadeFit],
        map_size_px: [u32; 2],
    ) -> Self {
        let mut ends_m = [f32::MAX; MAX_CASCADES as usize];
        ends_m.iter_mut().zip(ends).for_each(|(end_m, cascade)| *end_m = cascade.far_m as f32);
        let shrinks = self.filter_half * (1.0 - settings.far_filter);
        Self {
            select: match settings.select {
                CascadeSelection::Map => SELECT_MAP,
                CascadeSelection::Sphere => SELECT_SPHERE,
                CascadeSelection::Depth => SELECT_DEPTH,
            },
            blend: match settings.blend {
                CascadeBlend::Hard => BLEND_HARD,
                CascadeBlend::Soft(_) => BLEND_SOFT,
                CascadeBlend::Dither(_) => BLEND_DITHER,
            },
            branch_free: u32::from(settings.branch_free && settings.select == CascadeSelection::Depth),
            ends_m,
            blend_fraction: settings.blend.fraction(),
            edge_fade: settings.edge_fade,
            filter_falloff: shrinks / self.fade_end_m,
            texel_uv: map_size_px.map(|side| 1.0 / side as f32),
            ..self
        }
    }

    /// Returns the remaining strength of the shadow at a distance: 1 before the fade begins, 0 from its end on.
    /// The reference implementation of `tiles.wgsl`.
    #[must_use]
    pub fn fade(&self, distance_m: f32) -> f32 {
        ((self.fade_end_m - distance_m) * self.fade_per_m).clamp(0.0, 1.0)
    }
}
