//! `screen`: the shadows of another technique in screen space, evaluated into a mask before lighting; and `contact`, which adds
//! contact shadows to such a mask.

mod evaluate;
mod settings;

pub use settings::{ContactSettings, ScreenSettings};

use std::f32::consts::FRAC_1_SQRT_2;

use shadowgraph_core::{Buffer, Frame, Texture};
use shadowgraph_shaders::{MASK_ONLY, ModuleSource, SCREEN};

use super::mask::pass::{Layers, MaskPass};
use super::mask::{MASK, no_mask};
use crate::error::Error;
use crate::plan::ShadowInputs;
use crate::requirements::Requirements;
use crate::settings::{NamedSettings, ShadowSettings};
use crate::technique::binding::UNIFORM;
use crate::technique::{GpuData, GpuStruct, MaskLayers};
use crate::technique::{
    ShadowBinding, ShadowExplanation, ShadowOutputs, ShadowTechnique, SurfaceBuffers, add_checked,
};
use crate::views::{ShadowLight, ShadowView};
use evaluate::EvaluatePass;

/// Evaluates another technique once per pixel and light in a compute pass, and blurs the result; the mask of a technique that
/// has one is used as it is. Lit passes read one texel: their shaders contain no code of the other technique, unless there is
/// blended geometry or there are more lights than layers.
///
/// After Engel, "Cascaded Shadow Maps" (ShaderX5, 2006), *shadow prepass*, and Pranckevičius, "Deferred Cascaded Shadow
/// Maps" (2009).
pub struct ScreenShadows {
    name: String,
    inner: Box<dyn ShadowTechnique>,
    evaluate: EvaluatePass,
    blur: MaskPass,
    smooth: MaskPass,
    contact: Option<MaskPass>,
    no_mask: wgpu::Texture,
}

impl ScreenShadows {
    /// Creates the screen-space form of `inner`.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device, inner: Box<dyn ShadowTechnique>) -> Result<Self, Error> {
        let settings = GpuStruct::new::<ScreenSettings>("ScreenSettings");
        Ok(Self {
            name: format!("{}+{}", inner.name(), ScreenSettings::NAME),
            evaluate: EvaluatePass::new(device, inner.as_ref())?,
            blur: MaskPass::new(device, "blur", ("blur.wgsl", "cs_blur"), &settings, false)?,
            smooth: MaskPass::new(device, "smooth blur", ("blur.wgsl", "cs_smooth"), &settings, false)?,
            contact: None,
            no_mask: no_mask(device),
            inner,
        })
    }

    /// Creates the screen-space form of `inner` with contact shadows, for which maps are too coarse: a ray march over the surface
    /// buffers from each surface towards each light ([`ContactSettings`]).
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn with_contact(device: &wgpu::Device, inner: Box<dyn ShadowTechnique>) -> Result<Self, Error> {
        let base = Self::new(device, inner)?;
        let settings = GpuStruct::new::<ContactSettings>("ContactSettings");
        let contact = MaskPass::new(device, "contact", ("contact.wgsl", "cs_contact"), &settings, true)?;
        Ok(Self {
            name: format!("{}+{}", base.inner.name(), ContactSettings::NAME),
            contact: Some(contact),
            ..base
        })
    }

    /// Returns the variant without code of the inner technique.
    fn mask_only(&self) -> u32 {
        self.inner.variant_count()
    }

    /// Adds the passes over a mask that the settings enable.
    fn passes<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        settings: &ShadowSettings,
        buffers: &SurfaceBuffers,
        mut mask: Texture,
        layers: Layers,
        map_buffers: Option<&[Buffer; 2]>,
    ) -> Result<Texture, Error> {
        let blur: ScreenSettings = settings.techniques.get()?;
        if blur.blur_m > 0.0 {
            let own = frame.uniform(&narrowed(blur).bytes());
            for pass in [&self.blur, &self.blur, &self.smooth] {
                mask = pass.add_to(frame, buffers, &mask, layers, own, None);
            }
        }
        if let Some(contact) = &self.contact {
            let settings: ContactSettings = settings.techniques.get()?;
            let own = frame.uniform(&settings.bytes());
            let views = map_buffers.cloned().unwrap_or_else(|| without_maps(frame));
            mask = contact.add_to(frame, buffers, &mask, layers, own, Some(&views));
        }
        Ok(mask)
    }
}

impl ShadowTechnique for ScreenShadows {
    fn name(&self) -> &str {
        &self.name
    }

    fn requirements(&self, inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        self.inner.requirements(inputs)
    }

    fn reads_surface_buffers(&self) -> bool {
        true
    }

    fn traces_rays(&self) -> bool {
        self.inner.traces_rays()
    }

    fn variant_count(&self) -> u32 {
        self.mask_only() + 1
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        let first = self.inner.binding_types().len();
        let numbered = |module: ModuleSource| {
            let module = module.with_value("(MASK)", &format!("({first})"));
            module.with_value("(LAYERS)", &format!("({})", first + 1))
        };
        if variant >= self.mask_only() {
            return vec![numbered(MASK_ONLY)];
        }
        let mut modules = self.inner.modules(variant);
        if let Some(module) = modules.first_mut() {
            let path = "#define_import_path shadowgraph::";
            let source = module.source.replace(&format!("{path}technique"), &format!("{path}inner"));
            *module = ModuleSource::new(module.file.clone(), source);
        }
        modules.insert(0, numbered(SCREEN));
        modules
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        let mut types = self.inner.binding_types();
        types.extend([MASK, UNIFORM]);
        types
    }

    fn gpu_structs(&self) -> Vec<GpuStruct> {
        self.inner.gpu_structs()
    }

    fn explanation(&self) -> Option<ShadowExplanation> {
        self.inner.explanation()
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let buffers = buffers.ok_or_else(|| Error::MissingSurfaceBuffers { technique: self.name.clone() })?;
        let inner = self.inner.as_ref();
        let mut outputs = add_checked(inner, frame, inputs, requirements, Some(buffers))?;
        let mask_layers = MaskLayers::new(inputs.lights, &outputs.colored_lights);
        let layers = Layers::new(frame, &mask_layers);
        outputs.mask = frame.node("screen-space shadows", |frame| {
            if layers.count == 0 {
                return Ok(None);
            }
            let mask = match outputs.mask.take() {
                Some(mask) => mask,
                None => self.evaluate.add_to(frame, inner, buffers, &outputs, layers)?,
            };
            let maps = outputs.map_buffers.as_ref();
            self.passes(frame, inputs.settings, buffers, mask, layers, maps).map(Some)
        })?;
        let bound = outputs.mask.clone();
        let bound = bound.unwrap_or_else(|| frame.import_texture("no shadow mask", &self.no_mask, true));
        outputs
            .bindings
            .extend([ShadowBinding::TextureArray(bound.clone()), ShadowBinding::Uniform(layers.block)]);
        outputs.debug.push(("shadow mask", bound));
        let casting = inputs.lights.iter().filter(|light| light.casts_shadow).count();
        let masks_all = !buffers.has_blended && buffers.ground_height.is_none();
        if casting == mask_layers.light_count() && masks_all {
            outputs.variant = self.mask_only();
        }
        Ok(outputs)
    }
}

/// Returns the settings of each of two blurs, one after the other, that together have the variance of one with the given settings.
fn narrowed(blur: ScreenSettings) -> ScreenSettings {
    let [blur_m, blur_max_px] = [blur.blur_m, blur.blur_max_px].map(|radius| radius * FRAC_1_SQRT_2);
    ScreenSettings { blur_m, blur_max_px, ..blur }
}

/// Creates the buffers of views and lights of a technique without maps: a light without views.
fn without_maps(frame: &mut Frame<'_>) -> [Buffer; 2] {
    let view = frame.upload_buffer("no shadow views", bytemuck::bytes_of(&ShadowView::empty()).to_vec());
    [view, frame.upload_buffer("no shadow lights", bytemuck::bytes_of(&ShadowLight::default()).to_vec())]
}
