//! `raytraced`: shadows from rays through the scene's triangles.

mod settings;

pub use settings::RaytracedSettings;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use shadowgraph_core::{Bind, Buffer, Contents, Frame, Texture};
use shadowgraph_scene::Light;
use shadowgraph_shaders::{ModuleSource, RAYTRACED, TRACED_EXPLANATION, compose};

use super::compute::{dispatch, pipeline, shader};
use super::mask::pass::{Layers, MaskPass, mask_texture, workgroups};
use super::mask::{MASK, TARGET, no_mask};
use crate::error::Error;
use crate::plan::ShadowInputs;
use crate::rays::{GpuRayScene, SurfaceKinds};
use crate::requirements::Requirements;
use crate::settings::NamedSettings;
use crate::technique::binding::{FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::{
    ExplanationValues, GpuData, GpuStruct, MaskLayers, ShadowBinding, ShadowExplanation, ShadowFact,
    ShadowOutputs, ShadowTechnique, SurfaceBuffers, layout,
};

/// `TRACED_UNMASKED` of `traced.wgsl`.
const UNMASKED: u32 = u32::MAX - 1;

/// `TRACED_LIT` of `traced.wgsl`.
const LIT: u32 = u32::MAX;

/// `SLOTS_PER_LAYER` and `COLORED_SLOT` of `layers.wgsl`.
const SLOTS_PER_LAYER: u32 = 8;
const COLORED_SLOT: u32 = 4;

/// Shadows that are exact at any distance: with one ray to the centre of each light, other techniques are measured against it
/// ([`RaytracedSettings::hard`]); with several rays over the light's disc, edges are soft. Noise can be averaged over a few pixels of
/// the same surface. No other settings affect it.
///
/// A compute pass traces the visible surfaces into a screen mask for the first
/// [`MAX_MASK_LIGHTS`](crate::MAX_MASK_LIGHTS) lights; blended surfaces and all other points are traced in the pass that shades them.
pub struct Raytraced {
    trace: Trace,
    denoise: MaskPass,
    /// Replaces the triangles where there is no caster.
    no_rays: GpuRayScene,
    /// A placeholder for a missing mask.
    no_mask: wgpu::Texture,
}

/// The pass that writes the mask.
struct Trace {
    device: wgpu::Device,
    view_layout: wgpu::BindGroupLayout,
    rays_layout: wgpu::BindGroupLayout,
    screen_layout: wgpu::BindGroupLayout,
    /// Pipelines by variant, created on first use.
    pipelines: Mutex<BTreeMap<u32, Arc<wgpu::ComputePipeline>>>,
}

impl Raytraced {
    /// Creates the technique. Frames get the triangles with the [casters](crate::ShadowCasters::rays).
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            trace: Trace::new(device)?,
            denoise: MaskPass::new(
                device,
                "denoise",
                ("denoise.wgsl", "cs_denoise"),
                &settings_struct(),
                false,
            )?,
            no_rays: GpuRayScene::new(device),
            no_mask: no_mask(device),
        })
    }

    /// Adds the pass that traces all visible surfaces.
    fn trace<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        buffers: &SurfaceBuffers,
        rays: &'f GpuRayScene,
        traced: &Buffer,
        layers: Layers,
    ) -> Result<Texture, Error> {
        let mut mask = mask_texture(frame, "shadow mask", buffers, layers);
        let mut pass = frame.compute_pass("trace");
        let (view, lights) = (pass.uniform_buffer(&buffers.view), pass.storage_buffer(&buffers.lights));
        let (traced, surfaces) = (pass.storage_buffer(traced), pass.sample(&buffers.surfaces));
        let target = pass.storage_texture_mut(&mut mask, Contents::Overwrite);
        let size_px = buffers.size_px;
        let pipeline = self.trace.pipeline(variant(rays))?;
        pass.body(move |ctx| {
            let Trace { view_layout, rays_layout, screen_layout, .. } = &self.trace;
            let mut bound: Vec<_> = rays.buffers().iter().map(Bind::ExternalBuffer).collect();
            bound.push(Bind::Buffer(traced));
            let screen = [Bind::Texture(surfaces), Bind::TextureArray(target), Bind::Uniform(layers.block)];
            let groups = [
                ctx.bind_group(view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?,
                ctx.bind_group(rays_layout, &bound)?,
                ctx.bind_group(screen_layout, &screen)?,
            ];
            dispatch(&mut ctx.pass, &pipeline, &groups, workgroups(size_px, layers));
            Ok(())
        });
        Ok(mask)
    }

    /// Adds the passes that compute the mask; returns `None` if no light has a layer.
    fn mask<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        buffers: &SurfaceBuffers,
        rays: &'f GpuRayScene,
        traced: &Buffer,
        (layers, settings): (&MaskLayers, &RaytracedSettings),
    ) -> Result<Option<Texture>, Error> {
        let layers = Layers::new(frame, layers);
        if layers.count == 0 {
            return Ok(None);
        }
        let mask = self.trace(frame, buffers, rays, traced, layers)?;
        if settings.rays == 1 || settings.denoise_px == 0 {
            return Ok(Some(mask));
        }
        let own = frame.uniform(&settings.bytes());
        Ok(Some(self.denoise.add_to(frame, buffers, &mask, layers, own, None)))
    }

    /// Returns the triangles of the casters, or none where there is no caster.
    fn rays<'f>(&'f self, inputs: &ShadowInputs<'f>) -> Result<&'f GpuRayScene, Error> {
        match inputs.casters.rays() {
            Some(rays) => Ok(rays),
            None if inputs.casters.bounds().is_empty() => Ok(&self.no_rays),
            None => Err(Error::MissingRays { technique: self.name().into() }),
        }
    }
}

impl ShadowTechnique for Raytraced {
    fn name(&self) -> &str {
        RaytracedSettings::NAME
    }

    fn requirements(&self, _inputs: &ShadowInputs<'_>) -> Result<Requirements, Error> {
        Ok(Requirements::NONE)
    }

    fn reads_surface_buffers(&self) -> bool {
        true
    }

    fn traces_rays(&self) -> bool {
        true
    }

    fn variant_count(&self) -> u32 {
        OPAQUE + 1
    }

    fn modules(&self, variant: u32) -> Vec<ModuleSource> {
        vec![RAYTRACED, surfaces(variant)]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        // `rays.wgsl`, `traced.wgsl`, `raytraced.wgsl`.
        vec![STORAGE, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE, MASK]
    }

    fn gpu_structs(&self) -> Vec<GpuStruct> {
        vec![settings_struct()]
    }

    fn explanation(&self) -> Option<ShadowExplanation> {
        Some(ShadowExplanation { modules: vec![TRACED_EXPLANATION], describe })
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        _requirements: &Requirements,
        buffers: Option<&SurfaceBuffers>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let buffers =
            buffers.ok_or_else(|| Error::MissingSurfaceBuffers { technique: self.name().into() })?;
        let settings: RaytracedSettings = inputs.settings.techniques.get()?;
        let rays = self.rays(inputs)?;
        let colored_lights =
            if rays.surface_kinds().tints { (0..inputs.lights.len() as u32).collect() } else { Vec::new() };
        let layers = MaskLayers::new(inputs.lights, &colored_lights);
        let slots = mask_slots(inputs.lights, &layers);
        frame.node("shadows", |frame| {
            let traced = frame
                .upload_buffer("traced lights", traced_bytes(rays.max_coordinate_m(), &settings, &slots));
            let mask = self.mask(frame, buffers, rays, &traced, (&layers, &settings))?;
            let bound =
                mask.clone().unwrap_or_else(|| frame.import_texture("no shadow mask", &self.no_mask, true));
            let mut bindings: Vec<_> = rays.buffers().iter().map(ShadowBinding::ExternalBuffer).collect();
            bindings.push(ShadowBinding::Buffer(traced));
            bindings.push(ShadowBinding::TextureArray(bound.clone()));
            let (debug, variant) = (vec![("shadow mask", bound)], variant(rays));
            Ok(ShadowOutputs { bindings, mask, debug, variant, colored_lights, ..ShadowOutputs::default() })
        })
    }
}

/// Returns words for what `traced_explanation.wgsl` finds at a point.
fn describe(values: &ExplanationValues) -> Vec<ShadowFact> {
    match values {
        [0.0, ..] => Vec::new(),
        &[rays, offset_m, ..] => vec![
            ShadowFact::new("rays", [rays], ""),
            ShadowFact::new("distance of their origin from the surface", [offset_m], "m"),
        ],
    }
}

/// The variant for cutouts without tints; variant 0 has both.
const CUTOUTS: u32 = 1;

/// The variant for opaque surfaces alone.
const OPAQUE: u32 = 2;

/// Returns the variant of the shaders for a scene's surfaces.
fn variant(rays: &GpuRayScene) -> u32 {
    match rays.surface_kinds() {
        SurfaceKinds { tints: true, .. } => 0,
        SurfaceKinds { cutouts: true, .. } => CUTOUTS,
        SurfaceKinds { .. } => OPAQUE,
    }
}

/// Returns the replacement of `ray_surfaces.wgsl` in a variant.
fn surfaces(variant: u32) -> ModuleSource {
    let source = format!(
        "#define_import_path shadowgraph::ray_surfaces\n\
         const CUTOUTS: bool = {};\n\
         const TINTS: bool = {};\n",
        variant < OPAQUE,
        variant < CUTOUTS,
    );
    ModuleSource::new("ray_surfaces.wgsl of a variant", source)
}

/// Returns the struct `RaytracedSettings` of `raytraced_settings.wgsl`.
fn settings_struct() -> GpuStruct {
    GpuStruct::new::<RaytracedSettings>("RaytracedSettings")
}

/// Returns the place of each light of the scene in the mask, as `layers.wgsl` has it, or [`UNMASKED`], or [`LIT`].
fn mask_slots(lights: &[Light], layers: &MaskLayers) -> Vec<u32> {
    let without_slot = |light: &Light| if light.casts_shadow { UNMASKED } else { LIT };
    let mut slots: Vec<u32> = lights.iter().map(without_slot).collect();
    for (layer, lights) in (0u32..).zip(layers.iter()) {
        let first = if lights.len() == 1 { COLORED_SLOT } else { 0 };
        for (channel, &light) in (first..).zip(lights) {
            slots[light as usize] = layer * SLOTS_PER_LAYER + channel;
        }
    }
    slots
}

/// Returns the bytes of the struct `Traced` of `traced.wgsl`.
fn traced_bytes(max_coordinate_m: f32, settings: &RaytracedSettings, slots: &[u32]) -> Vec<u8> {
    let none = [LIT];
    let slots = if slots.is_empty() { &none } else { slots };
    let frame = [settings.sun_radius_rad.tan(), max_coordinate_m];
    [&settings.bytes(), bytemuck::cast_slice(&frame), bytemuck::cast_slice(slots)].concat()
}

impl Trace {
    fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let pass = Self {
            device: device.clone(),
            view_layout: layout(device, "view", &[UNIFORM, STORAGE]),
            rays_layout: layout(device, "rays", &[STORAGE; 6]),
            screen_layout: layout(device, "screen", &[FLOAT_MAP, TARGET, UNIFORM]),
            pipelines: Mutex::default(),
        };
        // Reports composition errors now, not in some frame.
        compose("raytrace.wgsl", &[surfaces(0)])?;
        Ok(pass)
    }

    /// Returns the pipeline of a variant.
    fn pipeline(&self, variant: u32) -> Result<Arc<wgpu::ComputePipeline>, Error> {
        let mut known = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = known.get(&variant) {
            return Ok(pipeline.clone());
        }
        let shader = shader(&self.device, "raytrace.wgsl", compose("raytrace.wgsl", &[surfaces(variant)])?);
        let layouts = [&self.view_layout, &self.rays_layout, &self.screen_layout];
        let pipeline = Arc::new(pipeline(&self.device, &shader, "cs_raytrace", &layouts));
        known.insert(variant, pipeline.clone());
        Ok(pipeline)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use shadowgraph_scene::LightKind;

    fn light(casts_shadow: bool) -> Light {
        let kind = LightKind::Directional { direction: DVec3::NEG_Y };
        Light { name: None, kind, color: Vec3::ONE, intensity: 1.0, casts_shadow }
    }

    #[test]
    fn lights_that_cast_shadows_have_a_place_in_the_mask_up_to_the_limit() {
        let mut lights = vec![light(true), light(false)];
        lights.extend((0..16).map(|_| light(true)));
        let slots = |colored: &[u32]| mask_slots(&lights, &MaskLayers::new(&lights, colored));
        assert_eq!(slots(&[])[..6], [0, LIT, 1, 2, 3, 8]);
        assert_eq!(slots(&[])[16..], [27, UNMASKED]);
        assert_eq!(slots(&[0])[..4], [COLORED_SLOT, LIT, 8, 9]);
    }

    #[test]
    fn the_struct_without_lights_is_not_empty() {
        let hard = RaytracedSettings::hard();
        let empty = traced_bytes(2.5, &hard, &[]);
        assert_eq!(
            (empty.len(), &empty[20..24], &empty[24..]),
            (28, &2.5f32.to_le_bytes()[..], &[255; 4][..])
        );
        assert_eq!(traced_bytes(0.0, &hard, &[0, 1]).len(), 32);
    }
}
