//! `sdsm`: cascades that the GPU fits to the visible surfaces.
//!
//! Lauritzen, Salvi and Lefohn, "Sample Distribution Shadow Maps" (2011): passes find the view depths and the extents of all
//! visible surfaces, and write splits and matrices into the buffer of views that casters are drawn with. The CPU knows neither, so
//! every cascade draws all casters that matter to the view.

mod fit;
mod settings;

pub use settings::SdsmSettings;

use shadowgraph_core::Frame;
use shadowgraph_shaders::ModuleSource;

use super::Pcf;
use crate::error::Error;
use crate::light_params::settings_requirements;
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;
use crate::settings::NamedSettings;
use crate::technique::{ShadowExplanation, ShadowOutputs, ShadowTechnique, SurfaceBuffers};
use fit::GpuFit;

/// The maps of [`Pcf`], with all cascades but the last fitted to the visible surfaces. The last cascade covers the whole view, for
/// blended geometry and points outside the image. It ignores `split`, `fit`, `select` and `cache` of
/// [`CascadeSettings`](crate::CascadeSettings).
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
        Ok(Requirements { fits_on_gpu: true, ..settings_requirements(inputs.settings) })
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

    fn explanation(&self) -> Option<ShadowExplanation> {
        self.pcf.explanation()
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let buffers =
            buffers.ok_or_else(|| Error::MissingSurfaceBuffers { technique: self.name().into() })?;
        let own = inputs.settings.techniques.get::<SdsmSettings>()?;
        self.pcf.add_fitted(frame, inputs, requirements, |frame, plan, views, lights| {
            self.fit.add_to(frame, inputs, (buffers, &own), plan, [views, lights])
        })
    }
}
