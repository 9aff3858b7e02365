//! `pcss`: shadow maps whose edges get softer away from what casts them, as those of real lights do.
//!
//! Fernando, "Percentage-Closer Soft Shadows" (SIGGRAPH sketches, 2005): a search around the point finds how far away what is in
//! the way is on average; from that and the light's size follows how wide the edge is, and so how wide to filter.

mod settings;

pub use settings::PcssSettings;

use bytemuck::{Pod, Zeroable};
use shadowgraph_core::Frame;
use shadowgraph_shaders::{MAPPED, ModuleSource, PCSS};

use crate::maps::comparison_sampler;
use crate::plan;
use crate::technique::binding::{COMPARISON_SAMPLER, UNIFORM};
use crate::technique::{ShadowBinding, ShadowOutputs, ShadowTechnique, SurfaceBuffers};
use crate::{Error, GpuStruct, Requirements, ShadowInputs, ShadowMaps, TechniqueSettings, gpu_struct};

/// Soft shadows from the maps of [`Pcf`](crate::Pcf); see the module `shadows/pcss.wgsl`.
pub struct Pcss {
    maps: ShadowMaps,
    sampler: wgpu::Sampler,
}

/// `SoftLights` of `pcss.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct SoftLights {
    sun_radius: f32,
    lamp_radius: f32,
    most_texels: f32,
    blocker_taps: u32,
    filter_taps: u32,
}

impl SoftLights {
    fn new(settings: &PcssSettings) -> Self {
        Self {
            sun_radius: settings.sun_radius_rad.tan(),
            lamp_radius: settings.lamp_radius_m,
            most_texels: settings.most_texels,
            blocker_taps: settings.blocker_taps,
            filter_taps: settings.filter_taps,
        }
    }
}

impl Pcss {
    /// Creates what stays the same for all frames.
    pub fn new(device: &wgpu::Device) -> Self {
        Self { maps: ShadowMaps::new(device), sampler: comparison_sampler(device) }
    }
}

/// What it needs with these settings of its own.
fn requirements(inputs: &ShadowInputs<'_>, own: &PcssSettings) -> Requirements {
    let requirements = plan::requirements(inputs.settings);
    Requirements {
        kernel_radius_texels: requirements.kernel_radius_texels.max(own.most_texels),
        ..requirements
    }
}

impl ShadowTechnique for Pcss {
    fn name(&self) -> &str {
        PcssSettings::NAME
    }

    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(requirements(inputs, &inputs.settings.techniques.get()?))
    }

    fn modules(&self, _variant: u32) -> Vec<ModuleSource> {
        vec![MAPPED, PCSS]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        [&ShadowMaps::BINDING_TYPES[..], &[COMPARISON_SAMPLER, UNIFORM]].concat()
    }

    fn gpu_structs(&self) -> Vec<GpuStruct> {
        vec![gpu_struct!(SoftLights { sun_radius, lamp_radius, most_texels, blocker_taps, filter_taps })]
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        _screen: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let own = inputs.settings.techniques.get()?;
        let requirements = requirements(inputs, &own);
        let maps = frame.node("shadows", |frame| self.maps.add_to(frame, inputs, &requirements))?;
        let soft = frame.uniform(bytemuck::bytes_of(&SoftLights::new(&own)));
        let mut bindings = maps.bindings();
        bindings.extend([ShadowBinding::Sampler(&self.sampler), ShadowBinding::Uniform(soft)]);
        Ok(maps.outputs(bindings))
    }
}
