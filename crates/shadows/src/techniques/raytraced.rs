//! `raytraced`: hard shadows by a ray a pixel through the scene's triangles.

use std::borrow::Cow;

use shadowgraph_core::{Bind, Buffer, Contents, Frame, Texture, TextureDesc};
use shadowgraph_scene::Light;
use shadowgraph_shaders::{ModuleSource, RAYTRACED};
use wgpu::util::DeviceExt as _;

use super::mask::{MASK, MASK_FORMAT, TARGET, WORKGROUP_PX, masked_lights, no_mask};
use crate::rays::GpuRayScene;
use crate::technique::binding::{FLOAT_MAP, STORAGE};
use crate::technique::layout;
use crate::technique::{Screen, ShadowBinding, ShadowOutputs, ShadowTechnique};
use crate::{Error, Needs, ShadowInputs};

/// `TRACED_UNMASKED` of `traced.wgsl`.
const UNMASKED: u32 = u32::MAX - 1;

/// `TRACED_LIT` of `traced.wgsl`.
const LIT: u32 = u32::MAX;

/// The technique that other techniques are measured against: every light that casts shadows sees or does not see a
/// surface, at any distance. No other setting changes it.
///
/// What the picture shows is traced by a compute pass into a screen mask, a layer a light, the first
/// [`MAX_MASK_LAYERS`](super::MAX_MASK_LAYERS) of them; blended surfaces and points elsewhere are traced where they are asked for.
pub struct Raytraced {
    trace: Trace,
    /// The bindings of `rays.wgsl`.
    rays: [wgpu::Buffer; 5],
    reach_m: f32,
    /// What is bound where there is no mask.
    no_mask: wgpu::Texture,
}

/// The pass that writes the mask.
struct Trace {
    view_layout: wgpu::BindGroupLayout,
    rays_layout: wgpu::BindGroupLayout,
    screen_layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl Raytraced {
    /// Uploads the triangles. They are relative to a frame's origin: for frames with another origin, make another.
    ///
    /// # Errors
    /// If a shader does not compose.
    pub fn new(device: &wgpu::Device, scene: &GpuRayScene) -> Result<Self, Error> {
        let buffer = |contents: &[u8]| {
            let (label, usage) = (Some("rays"), wgpu::BufferUsages::STORAGE);
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label, contents, usage })
        };
        Ok(Self {
            trace: Trace::new(device)?,
            rays: scene.buffers().map(buffer),
            reach_m: scene.reach_m,
            no_mask: no_mask(device),
        })
    }

    /// Adds the pass that traces all that the picture shows.
    fn mask<'f>(&'f self, frame: &mut Frame<'f>, screen: &Screen, traced: &Buffer, layers: u32) -> Texture {
        let [width, height] = screen.size_px;
        let desc = TextureDesc::d2(width, height, MASK_FORMAT).layers(layers);
        let mut mask = frame.create_texture("shadow mask", desc);
        let mut pass = frame.compute_pass("trace");
        let (view, lights) = (pass.storage_buffer(&screen.view), pass.storage_buffer(&screen.lights));
        let (traced, surfaces) = (pass.storage_buffer(traced), pass.sample(&screen.surfaces));
        let target = pass.storage_texture_mut(&mut mask, Contents::Cover);
        pass.body(move |ctx| {
            let Trace { view_layout, rays_layout, screen_layout, pipeline } = &self.trace;
            let mut rays: Vec<_> = self.rays.iter().map(Bind::OwnBuffer).collect();
            rays.push(Bind::Buffer(traced));
            let groups = [
                ctx.bind_group(view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?,
                ctx.bind_group(rays_layout, &rays)?,
                ctx.bind_group(screen_layout, &[Bind::Texture(surfaces), Bind::TextureArray(target)])?,
            ];
            ctx.pass.set_pipeline(pipeline);
            for (index, group) in (0..).zip(&groups) {
                ctx.pass.set_bind_group(index, group, &[]);
            }
            ctx.pass.dispatch_workgroups(width.div_ceil(WORKGROUP_PX), height.div_ceil(WORKGROUP_PX), layers);
            Ok(())
        });
        mask
    }
}

impl ShadowTechnique for Raytraced {
    fn name(&self) -> &str {
        "raytraced"
    }

    fn needs(&self, _inputs: &ShadowInputs<'_>) -> Result<Needs, Error> {
        Ok(Needs::NONE)
    }

    fn reads_surfaces(&self) -> bool {
        true
    }

    fn modules(&self, _variant: u32) -> Vec<ModuleSource> {
        vec![RAYTRACED]
    }

    fn binding_types(&self) -> Vec<wgpu::BindingType> {
        // `rays.wgsl`, `traced.wgsl`, `raytraced.wgsl`.
        vec![STORAGE, STORAGE, STORAGE, STORAGE, STORAGE, STORAGE, MASK]
    }

    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        screen: Option<&Screen>,
    ) -> Result<ShadowOutputs<'f>, Error> {
        let screen = screen.ok_or_else(|| Error::NoSurfaces { technique: self.name().into() })?;
        let layers = mask_layers(inputs.lights);
        let count = layers.iter().filter(|&&layer| layer < UNMASKED).count() as u32;
        Ok(frame.node("shadows", |frame| {
            let traced = frame.upload_buffer("traced lights", record(self.reach_m, &layers));
            let mask = (count > 0).then(|| self.mask(frame, screen, &traced, count));
            let bound =
                mask.clone().unwrap_or_else(|| frame.import_texture("no shadow mask", &self.no_mask, true));
            let mut bindings: Vec<_> = self.rays.iter().map(ShadowBinding::OwnBuffer).collect();
            bindings.push(ShadowBinding::Buffer(traced));
            bindings.push(ShadowBinding::TextureArray(bound.clone()));
            ShadowOutputs { bindings, mask, debug: vec![("shadow mask", bound)], ..ShadowOutputs::default() }
        }))
    }
}

/// What each light of the scene has: a layer, rays alone, or light.
fn mask_layers(lights: &[Light]) -> Vec<u32> {
    let unmasked = |light: &Light| if light.casts_shadow { UNMASKED } else { LIT };
    let mut layers: Vec<u32> = lights.iter().map(unmasked).collect();
    for (layer, light) in (0..).zip(masked_lights(lights)) {
        layers[light as usize] = layer;
    }
    layers
}

/// A `Traced` of `traced.wgsl`.
fn record(reach_m: f32, layers: &[u32]) -> Vec<u8> {
    let none = [LIT];
    let layers = if layers.is_empty() { &none } else { layers };
    [bytemuck::bytes_of(&reach_m), bytemuck::cast_slice(layers)].concat()
}

impl Trace {
    fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let module = shadowgraph_shaders::compose("raytrace.wgsl", &[])?;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("raytrace.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let view_layout = layout(device, "view", &[STORAGE; 2]);
        let rays_layout = layout(device, "rays", &[STORAGE; 6]);
        let screen_layout = layout(device, "screen", &[FLOAT_MAP, TARGET]);
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("raytrace"),
            bind_group_layouts: &[Some(&view_layout), Some(&rays_layout), Some(&screen_layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("raytrace"),
            layout: Some(&pipeline_layout),
            module: &shader,
            entry_point: Some("cs_raytrace"),
            compilation_options: Default::default(),
            cache: None,
        });
        Ok(Self { view_layout, rays_layout, screen_layout, pipeline })
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
    fn lights_that_cast_shadows_get_layers_until_there_are_no_more() {
        let mut lights = vec![light(true), light(false)];
        lights.extend((0..16).map(|_| light(true)));
        let layers = mask_layers(&lights);
        assert_eq!(layers[..3], [0, LIT, 1]);
        assert_eq!(layers[16..], [15, UNMASKED]);
    }

    #[test]
    fn the_record_of_no_light_is_not_empty() {
        assert_eq!(record(2.5, &[]), [2.5f32.to_le_bytes(), [255; 4]].concat());
        assert_eq!(record(0.0, &[0, 1]).len(), 12);
    }
}
