//! The parameters of one light's shadows: the settings of its map, and the light's own.

use crate::requirements::{Requirements, snapping_px};
use crate::settings::{
    BiasMethod, BiasSettings, DistanceMeasure, LightShadows, NormalBias, ShadowFilter, ShadowSettings,
};

/// The radius around a point that `shadows/crease.wgsl` reads, texels.
const CREASE_RADIUS_TEXELS: f32 = 2.0;

/// The parameters of one light's shadows.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LightShadowParams {
    pub(crate) bias: BiasSettings,
    pub(crate) filter: ShadowFilter,
    /// Radius around a point that is read, texels.
    pub(crate) kernel_radius_texels: f32,
    /// Step in which tiles of directional lights move, texels.
    pub(crate) step_texels: u32,
    /// Distance beyond that at which a blocker still matters, metres.
    pub(crate) blocker_reach_m: f64,
    pub(crate) strength: f32,
    pub(crate) supersample: bool,
    pub(crate) close_creases: bool,
    pub(crate) fade_fraction: f32,
    pub(crate) measure: DistanceMeasure,
    pub(crate) near_m: Option<f64>,
    pub(crate) importance: f64,
}

impl LightShadowParams {
    /// Returns the parameters of a light in a map whose filter is `map_filter`.
    pub(crate) fn new(
        settings: &ShadowSettings,
        own: Option<&LightShadows>,
        map_filter: ShadowFilter,
    ) -> Self {
        let ShadowSettings { fade_fraction, measure, supersample, close_creases, ref bias, .. } = *settings;
        let filter = own.and_then(|own| own.filter).unwrap_or(map_filter);
        let bias = own.map_or_else(
            || bias.clone(),
            |own| BiasSettings {
                depth_texels: own.depth_texels.unwrap_or(bias.depth_texels),
                slope: own.slope.unwrap_or(bias.slope),
                normal_texels: own.normal_texels.unwrap_or(bias.normal_texels),
                ..bias.clone()
            },
        );
        let crease_radius_texels = if close_creases { CREASE_RADIUS_TEXELS } else { 0.0 };
        Self {
            bias,
            filter,
            kernel_radius_texels: filter.kernel_radius_texels().max(crease_radius_texels),
            step_texels: 1,
            blocker_reach_m: 0.0,
            strength: own.map_or(1.0, |own| own.strength),
            supersample,
            close_creases,
            fade_fraction,
            measure,
            near_m: own.and_then(|own| own.near_m).map(f64::from),
            importance: own.map_or(1.0, |own| f64::from(own.importance)),
        }
    }

    /// Adds a technique's requirements.
    pub(crate) fn with_requirements(self, requirements: &Requirements) -> Self {
        let kernel_radius_texels = self.kernel_radius_texels.max(requirements.kernel_radius_texels);
        let (step_texels, blocker_reach_m) =
            (requirements.step_texels, f64::from(requirements.blocker_reach_m));
        Self { kernel_radius_texels, step_texels, blocker_reach_m, ..self }
    }

    /// Returns the distance around a point within which casters matter, metres, for texels of width `texel_m`.
    pub(crate) fn radius_m(&self, texel_m: f64, bias_scale: f32) -> f64 {
        self.margin_px(bias_scale) * texel_m + self.blocker_reach_m
    }

    /// Returns the border on each side of a tile, pixels: the radius that is read.
    pub(crate) fn border_px(&self) -> u32 {
        self.kernel_radius_texels.ceil() as u32
    }

    /// Returns the slope-scaled depth bias with which casters are drawn; see [`CasterTarget`](crate::CasterTarget).
    pub(crate) fn slope_bias_milli(&self, bias_scale: f32) -> u32 {
        match self.bias.method {
            BiasMethod::Raster => (1000.0 * self.bias.slope * bias_scale).round() as u32,
            _ => 0,
        }
    }

    pub(crate) fn normal_sine(&self) -> bool {
        self.bias.normal == NormalBias::Sine
    }

    /// Returns the largest offset along the normal, texels.
    pub(crate) fn normal_texels(&self) -> f32 {
        let scale = if self.normal_sine() {
            1.0
        } else {
            std::f32::consts::SQRT_2 * self.filter.kernel_radius_texels()
        };
        self.bias.normal_texels * scale
    }

    /// Returns the margin inside each edge of a tile that points must keep, pixels: filter, bias, and what snapping can be off.
    pub(crate) fn margin_px(&self, bias_scale: f32) -> f64 {
        f64::from(self.kernel_radius_texels + self.normal_texels() * bias_scale.max(1.0))
            + snapping_px(self.step_texels)
    }
}

/// Returns the largest requirements of any light's settings.
pub(crate) fn settings_requirements(settings: &ShadowSettings) -> Requirements {
    let all = [settings.cascades.filter, settings.atlas.filter].into_iter().flat_map(|map_filter| {
        let lights = settings.lights.iter().map(Some).chain([None]);
        lights.map(move |own| LightShadowParams::new(settings, own, map_filter))
    });
    all.fold(Requirements::NONE, |most, params| Requirements {
        kernel_radius_texels: most.kernel_radius_texels.max(params.kernel_radius_texels),
        bias_texels: most.bias_texels.max(params.normal_texels()),
        ..most
    })
}
