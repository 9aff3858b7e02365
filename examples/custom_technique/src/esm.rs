//! Exponential shadow maps, after Annen et al. (2008): visibility falls off exponentially with the distance behind the occluder, so edges
//! are smooth even with few texels.

use shadowgraph::core::Frame;
use shadowgraph::shaders::{MAPPED, ModuleSource};
use shadowgraph::shadows::binding::UNIFORM;
use shadowgraph::shadows::{
    Error, GpuData, GpuStruct, NamedSettings, Requirements, ShadowBinding, ShadowExplanation, ShadowInputs,
    ShadowMaps, ShadowOutputs, ShadowTechnique, SurfaceBuffers, TechniqueKind, declare_settings, gpu_struct,
};

/// The technique for the registry: a name, a description, a constructor, and the settings.
pub const ESM: TechniqueKind =
    TechniqueKind::new("esm", "exponential shadow maps: smooth edges from four texels", |context| {
        Ok(Box::new(Esm { maps: ShadowMaps::new(context.device) }))
    })
    .with_settings::<EsmSettings>();

declare_settings! {
    /// The settings in a file: `(techniques: {"esm": (falloff_m: 0.1)})`.
    pub struct EsmSettings {
        /// Distance behind an occluder at which visibility has fallen to 1/e.
        falloff_m: f32 = 0.05, 0.001..=10, in "metres";
    }
}

impl NamedSettings for EsmSettings {
    const NAME: &'static str = "esm";
}

gpu_struct! {
    /// `Falloff` of `esm.wgsl`.
    struct Falloff {
        per_metre: f32,
    }
}

/// Shadow maps of the library with our own filter.
struct Esm {
    maps: ShadowMaps,
}

impl ShadowTechnique for Esm {
    fn name(&self) -> &str {
        EsmSettings::NAME
    }

    fn requirements(&self, _inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        // Four texels around a point: tiles get a border of two.
        Ok(Requirements { kernel_radius_texels: 2.0, ..Requirements::NONE })
    }

    fn modules(&self, _variant: u32) -> Vec<ModuleSource> {
        // MAPPED finds the tiles of a point and calls the filter, which is our file.
        vec![MAPPED, ModuleSource::new("esm.wgsl", include_str!("esm.wgsl"))]
    }

    fn binding_types(&self) -> Vec<shadowgraph::wgpu::BindingType> {
        [&ShadowMaps::BINDING_TYPES[..], &[UNIFORM]].concat()
    }

    fn gpu_structs(&self) -> Vec<GpuStruct> {
        vec![GpuStruct::new::<Falloff>("Falloff")]
    }

    fn explanation(&self) -> Option<ShadowExplanation> {
        // `shadowgraph pixel` names the texel that a point is read from, depths and biases.
        Some(ShadowMaps::explanation())
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        requirements: &Requirements,
        _buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let settings: EsmSettings = inputs.settings.techniques.get()?;
        let maps = frame.node("esm", |frame| self.maps.add_to(frame, inputs, requirements))?;
        let falloff = Falloff { per_metre: 1.0 / settings.falloff_m };
        let mut bindings = maps.bindings();
        bindings.push(ShadowBinding::Uniform(frame.uniform(&falloff.bytes())));
        Ok(maps.outputs(bindings))
    }
}
