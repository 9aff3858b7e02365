//! `sdsm`: cascades that the GPU fits to what the picture shows.
//!
//! Lauritzen, Salvi and Lefohn, "Sample Distribution Shadow Maps" (2011): passes find the view depths and the extents of all
//! surfaces, and write splits and matrices into the buffer of views from which casters are then drawn. The CPU knows neither, so it
//! draws all casters that matter to the view into every cascade.

mod fit;
mod settings;

pub use settings::SdsmSettings;

use shadowgraph_core::Frame;
use shadowgraph_shaders::ModuleSource;

use super::Pcf;
use crate::technique::{ShadowOutputs, ShadowTechnique, SurfaceBuffers};
use crate::{Error, Requirements, ShadowInputs, TechniqueSettings};
use fit::GpuFit;

/// The maps of [`Pcf`], with all cascades but the last fitted to the surfaces that are seen. The last covers the whole view: what is
/// blended, or beside the picture, finds its shadows there. Of [`CascadeSettings`](crate::CascadeSettings) it takes neither `split`
/// and `fit` nor `select` and `cache`.
pub struct Sdsm {
    pcf: Pcf,
    fit: GpuFit,
}

impl Sdsm {
    /// Creates what stays the same for all frames.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { pcf: Pcf::new(device), fit: GpuFit::new(device)? })
    }
}

impl ShadowTechnique for Sdsm {
    fn name(&self) -> &str {
        SdsmSettings::NAME
    }

    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(Requirements { fits_on_gpu: true, ..self.pcf.requirements(inputs)? })
    }

    fn reads_surface_buffers(&self) -> bool {
        true
    }

    fn variant_count(&self) -> u32 {
        self.pcf.variant_count()
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        self.pcf.modules(variant)
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        self.pcf.binding_types()
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        screen: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let screen = screen.ok_or_else(|| Error::MissingSurfaceBuffers { technique: self.name().into() })?;
        let (requirements, own) =
            (self.requirements(inputs)?, inputs.settings.techniques.get::<SdsmSettings>()?);
        self.pcf.add_fitted(frame, inputs, &requirements, |frame, plan, views, lights| {
            self.fit.add_to(frame, inputs, (screen, &own), plan, [views, lights])
        })
    }
}
