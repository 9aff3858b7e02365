//! The variants of the lookup: code that no light of a frame needs is not compiled.

use shadowgraph_shaders::ModuleSource;

use super::projections::GpuProjection;
use crate::views::{BIAS_PLANE, ShadowLight};

/// Taps along each axis of the default filter, and of that of penumbrae.
pub(super) const USUAL_TAPS: u32 = 4;

/// What the lookups of a frame's shadowed lights have in common, and what they need.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Variant {
    /// All are directional.
    directional: bool,
    /// All have the default bias and the default filter.
    usual: bool,
    /// They have penumbrae.
    soft: bool,
    /// Translucent casters tint light.
    tinted: bool,
}

impl Variant {
    /// The number of variants.
    pub(super) const COUNT: u32 = 16;

    /// Returns the best variant for the lights of a frame.
    pub(super) fn for_frame(lights: &[ShadowLight], projections: &[GpuProjection], tinted: bool) -> Self {
        let mut shadowed = lights.iter().filter(|light| light.view_count > 0);
        let soft = projections.iter().any(|projection| projection.max_radius_m > 0.0);
        let is_usual = |light: &ShadowLight| {
            light.filter_taps == USUAL_TAPS
                && light.bias_method == BIAS_PLANE
                && light.normal_sine == 1
                && light.fades_by_radius == 0
        };
        Self {
            directional: projections.iter().all(|projection| projection.is_perspective == 0),
            usual: shadowed.all(is_usual),
            soft,
            tinted,
        }
    }

    pub(super) fn index(self) -> u32 {
        let Self { directional, usual, soft, tinted } = self;
        [usual, directional, soft, tinted].iter().rev().fold(0, |index, &bit| 2 * index + u32::from(bit))
    }

    /// Returns whether the lights of the variant with an index have penumbrae.
    pub(super) fn has_penumbrae(index: u32) -> bool {
        Self::get(index).soft
    }

    fn get(index: u32) -> Self {
        let bit = |number: u32| index >> number & 1 == 1;
        Self { usual: bit(0), directional: bit(1), soft: bit(2), tinted: bit(3) }
    }

    /// Returns the replacement of `shadows/variant.wgsl` for the variant with an index.
    pub(super) fn module(index: u32) -> ModuleSource {
        let Self { directional, usual, tinted, .. } = Self::get(index);
        let taps = if usual { USUAL_TAPS } else { 0 };
        let text = format!(
            "#define_import_path shadowgraph::shadows::variant\n\
             const FILTER_TAPS: u32 = {taps}u;\n\
             const DIRECTIONAL: bool = {directional};\n\
             const SIMPLE: bool = {usual};\n\
             const TINTED: bool = {tinted};\n",
        );
        ModuleSource::new(format!("shadows/variant.wgsl of virtual {index}"), text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VirtualSettings;
    use bytemuck::Zeroable;

    #[test]
    fn every_index_is_that_of_its_variant() {
        for index in 0..Variant::COUNT {
            assert_eq!(Variant::get(index).index(), index);
        }
    }

    #[test]
    fn a_light_that_needs_more_removes_what_lights_have_in_common() {
        let taps = VirtualSettings::default().filter.taps();
        let sun = ShadowLight { view_count: 1, filter_taps: taps, normal_sine: 1, ..ShadowLight::default() };
        let narrow = ShadowLight { filter_taps: 2, ..sun };
        let (directional, local) =
            (GpuProjection::zeroed(), GpuProjection { is_perspective: 1, ..GpuProjection::zeroed() });
        let of = |lights: &[ShadowLight], projections: &[GpuProjection]| {
            Variant::for_frame(lights, projections, false).index()
        };
        assert_eq!(of(&[sun, ShadowLight::default()], &[directional]), 3);
        assert_eq!(of(&[sun, narrow], &[directional]), 2);
        assert_eq!(of(&[sun], &[directional, local]), 1);
        assert_eq!(of(&[narrow], &[local]), 0);
        let wide = GpuProjection { max_radius_m: 1.0, ..directional };
        assert_eq!(of(&[sun], &[wide]), 7);
        assert_eq!(Variant::for_frame(&[sun], &[directional], true).index(), 11);
    }
}
