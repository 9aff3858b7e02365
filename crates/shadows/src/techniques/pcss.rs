//! `pcss`: shadow maps whose edges get softer away from what casts them, as those of real lights do.
//!
//! Fernando, "Percentage-Closer Soft Shadows" (SIGGRAPH sketches, 2005): a search around the point finds how far away what is in
//! the way is on average; from that and the light's size follows how wide the edge is, and so how wide to filter.

use bytemuck::{Pod, Zeroable};
use shadowgraph_core::Frame;
use shadowgraph_shaders::{MAPPED, ModuleSource, PCSS};

use super::layout::{DEPTH_MAP, STORAGE, UNIFORM, comparison_sampler, layout};
use crate::plan;
use crate::technique::{Screen, ShadowBinding, ShadowOutputs, ShadowTechnique};
use crate::{Error, Needs, PcssSettings, ShadowInputs, ShadowMaps};

/// Soft shadows from the maps of [`Pcf`](crate::Pcf); see the module `shadows/pcss.wgsl`.
pub struct Pcss {
    layout: wgpu::BindGroupLayout,
    maps: ShadowMaps,
    sampler: wgpu::Sampler,
}

/// What each binding of group 1 is: `tiles.wgsl` and `pcss.wgsl`.
const BINDINGS: [wgpu::BindingType; 6] = [
    STORAGE,
    STORAGE,
    DEPTH_MAP,
    DEPTH_MAP,
    wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison),
    UNIFORM,
];

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
        Self {
            layout: layout(device, "pcss shadows", &BINDINGS),
            maps: ShadowMaps::new(device),
            sampler: comparison_sampler(device),
        }
    }
}

impl ShadowTechnique for Pcss {
    fn name(&self) -> &str {
        "pcss"
    }

    fn needs(&self, inputs: &ShadowInputs<'_>) -> Needs {
        let needs = plan::needs(inputs.settings);
        let kernel_radius_texels = needs.kernel_radius_texels.max(inputs.settings.pcss.most_texels);
        Needs { kernel_radius_texels, ..needs }
    }

    fn modules(&self, _variant: u32) -> Vec<ModuleSource> {
        vec![MAPPED, PCSS]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        BINDINGS.into()
    }

    fn bind_group_layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        _screen: Option<&Screen>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let kernel_texels = self.needs(inputs).kernel_radius_texels;
        let maps = frame.node("shadows", |frame| self.maps.add_to(frame, inputs, kernel_texels))?;
        let soft = frame.uniform(bytemuck::bytes_of(&SoftLights::new(&inputs.settings.pcss)));
        let mut bindings = maps.bindings();
        bindings.extend([ShadowBinding::Sampler(&self.sampler), ShadowBinding::Uniform(soft)]);
        Ok(ShadowOutputs {
            variant: 0,
            debug_light: maps.main_light,
            debug: vec![("cascades", maps.cascades.texture), ("atlas", maps.atlas.texture)],
            bindings,
            unshadowed: maps.unshadowed,
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use shadowgraph_shaders::{compose, layout};
    use std::mem::offset_of;

    #[test]
    fn the_block_lies_in_wgsl_as_in_rust() {
        let module = compose("forward.wgsl", &[MAPPED, PCSS]).unwrap();
        let fields = [
            ("sun_radius", offset_of!(SoftLights, sun_radius)),
            ("lamp_radius", offset_of!(SoftLights, lamp_radius)),
            ("most_texels", offset_of!(SoftLights, most_texels)),
            ("blocker_taps", offset_of!(SoftLights, blocker_taps)),
            ("filter_taps", offset_of!(SoftLights, filter_taps)),
        ];
        layout::check(&module, "SoftLights", size_of::<SoftLights>(), &fields).unwrap();
    }
}
