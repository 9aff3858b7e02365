//! `pcss`: shadow maps with penumbrae that widen with the distance to the occluder, as those of real lights do.
//!
//! Fernando, "Percentage-Closer Soft Shadows" (SIGGRAPH sketches, 2005): a search around the point finds the mean
//! distance of the blockers; the width of the penumbra, and so of the filter, follows from that and the light's size.

mod settings;

pub use settings::PcssSettings;

use shadowgraph_core::Frame;
use shadowgraph_shaders::{MAPPED, ModuleSource, PCSS};

use crate::error::Error;
use crate::gpu_struct;
use crate::light_params::settings_requirements;
use crate::lookup_variant::LookupVariant;
use crate::maps::{ShadowMaps, comparison_sampler};
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;
use crate::settings::NamedSettings;
use crate::technique::binding::{COMPARISON_SAMPLER, UNIFORM};
use crate::technique::{GpuData, GpuStruct};
use crate::technique::{ShadowBinding, ShadowExplanation, ShadowOutputs, ShadowTechnique, SurfaceBuffers};

/// Soft shadows from the maps of [`Pcf`](crate::Pcf); see the module `shadows/pcss.wgsl`.
pub struct Pcss {
    maps: ShadowMaps,
    sampler: wgpu::Sampler,
}

gpu_struct! {
    /// `Pcss` of `pcss.wgsl`.
    struct Block {
        settings: PcssSettings,
        sun_tangent: f32,
    }
}

impl Pcss {
    /// Creates what stays the same for all frames.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { maps: ShadowMaps::new(device), sampler: comparison_sampler(device) }
    }
}

impl ShadowTechnique for Pcss {
    fn name(&self) -> &str {
        PcssSettings::NAME
    }

    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        let own: PcssSettings = inputs.settings.techniques.get()?;
        let base = settings_requirements(inputs.settings);
        Ok(Requirements {
            kernel_radius_texels: base.kernel_radius_texels.max(own.max_radius_texels),
            ..base
        })
    }

    fn variant_count(&self) -> u32 {
        LookupVariant::count_without_taps()
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        [vec![MAPPED, PCSS], LookupVariant::modules(variant)].concat()
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        [&ShadowMaps::BINDING_TYPES[..], &[COMPARISON_SAMPLER, UNIFORM]].concat()
    }

    fn gpu_structs(&self) -> Vec<GpuStruct> {
        vec![GpuStruct::new::<Block>("Pcss")]
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
        let settings: PcssSettings = inputs.settings.techniques.get()?;
        let maps = frame.node("shadows", |frame| self.maps.add_to(frame, inputs, requirements))?;
        let block = Block { sun_tangent: settings.sun_radius_rad.tan(), settings };
        let block = frame.uniform(&block.bytes());
        let mut bindings = maps.bindings();
        bindings.extend([ShadowBinding::Sampler(&self.sampler), ShadowBinding::Uniform(block)]);
        let variant = maps.variant.without_taps().index();
        Ok(ShadowOutputs { variant, ..maps.outputs(bindings) })
    }
}
