//! `pcf`: cascades for the brightest directional lights, an atlas for the others, percentage-closer filtering.

use shadowgraph_core::{Buffer, Frame};
use shadowgraph_shaders::{MAPPED, ModuleSource};

use crate::error::Error;
use crate::lookup_variant::LookupVariant;
use crate::maps::{ShadowMaps, comparison_sampler};
use crate::plan::{ShadowInputs, ShadowPlan};
use crate::requirements::Requirements;
use crate::technique::binding::COMPARISON_SAMPLER;
use crate::technique::{ShadowBinding, ShadowExplanation, ShadowOutputs, ShadowTechnique, SurfaceBuffers};

/// The default technique; see the modules `shadows/tiles.wgsl` and `shadows/pcf.wgsl` for how its maps are read.
pub struct Pcf {
    maps: ShadowMaps,
    sampler: wgpu::Sampler,
}

impl Pcf {
    /// Creates what stays the same for all frames.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { maps: ShadowMaps::new(device), sampler: comparison_sampler(device) }
    }

    /// Adds the passes as `add_to` does, with views that `fit` may replace.
    pub(super) fn add_fitted<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        fit: impl FnOnce(&mut Frame<'f>, &ShadowPlan, &Buffer, &Buffer) -> Buffer,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let maps = frame.node("shadows", |frame| self.maps.add_fitted(frame, inputs, requirements, fit))?;
        let mut bindings = maps.bindings();
        bindings.push(ShadowBinding::Sampler(&self.sampler));
        Ok(ShadowOutputs { variant: maps.variant.index(), ..maps.outputs(bindings) })
    }
}

impl ShadowTechnique for Pcf {
    fn name(&self) -> &str {
        "pcf"
    }

    fn requirements(&self, _inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        // Each light's own filter sets the borders of its tiles.
        Ok(Requirements::NONE)
    }

    fn variant_count(&self) -> u32 {
        LookupVariant::all().len() as u32
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        [vec![MAPPED], LookupVariant::modules(variant)].concat()
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        [&ShadowMaps::BINDING_TYPES[..], &[COMPARISON_SAMPLER]].concat()
    }

    fn explanation(&self) -> Option<ShadowExplanation> {
        Some(ShadowMaps::explanation())
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        _buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        self.add_fitted(frame, inputs, requirements, |_, _, views, _| views.clone())
    }
}
