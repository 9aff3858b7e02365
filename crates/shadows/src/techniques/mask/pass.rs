//! Passes over a screen mask.

use shadowgraph_core::{Bind, Contents, Frame, Texture, TextureDesc, Uniform};
use shadowgraph_scene::Light;
use shadowgraph_shaders::compose;

use super::{MASK, MASK_FORMAT, MAX_MASK_LAYERS, TARGET, WORKGROUP_PX, masked_lights};
use crate::Error;
use crate::technique::binding::{FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::{SurfaceBuffers, layout};
use crate::techniques::compute::{dispatch, pipeline, shader};

/// The lights of a mask.
#[derive(Clone, Copy)]
pub(in crate::techniques) struct Layers {
    /// `MaskLayers` of `layers.wgsl`.
    pub(in crate::techniques) record: Uniform,
    /// How many there are.
    pub(in crate::techniques) count: u32,
}

impl Layers {
    /// Those of the [masked lights](masked_lights).
    pub(in crate::techniques) fn new(frame: &mut Frame<'_>, lights: &[Light]) -> Self {
        let lights = masked_lights(lights);
        let mut of_layers = [u32::MAX; MAX_MASK_LAYERS];
        of_layers[..lights.len()].copy_from_slice(&lights);
        let count = lights.len() as u32;
        let record = [bytemuck::bytes_of(&[count, 0, 0, 0]), bytemuck::bytes_of(&of_layers)].concat();
        Self { record: frame.uniform(&record), count }
    }
}

/// A compute pass that makes one screen mask of another: what it knows besides are the surfaces that the picture shows, the
/// camera, the lights, and a block of its own.
pub(in crate::techniques) struct MaskPass {
    name: &'static str,
    view_layout: wgpu::BindGroupLayout,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl MaskPass {
    /// Makes the pipeline of a built-in file with this entry point.
    pub(in crate::techniques) fn new(
        device: &wgpu::Device,
        name: &'static str,
        file: &str,
        entry: &str,
    ) -> Result<Self, Error> {
        let view_layout = layout(device, "view", &[STORAGE; 2]);
        let own_layout = layout(device, name, &[FLOAT_MAP, MASK, TARGET, UNIFORM, UNIFORM]);
        let module = compose(file, &[])?;
        let shader = shader(device, file, module);
        let pipeline = pipeline(device, &shader, entry, &[&view_layout, &own_layout]);
        Ok(Self { name, view_layout, layout: own_layout, pipeline })
    }

    /// Adds the pass, and returns what it makes of `mask`.
    pub(in crate::techniques) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        screen: &SurfaceBuffers,
        mask: &Texture,
        layers: Layers,
        own: Uniform,
    ) -> Texture {
        let mut made = mask_texture(frame, format_args!("shadow mask, {}", self.name), screen, layers);
        let mut pass = frame.compute_pass(self.name);
        let (view, lights) = (pass.storage_buffer(&screen.view), pass.storage_buffer(&screen.lights));
        let (surfaces, mask) = (pass.sample(&screen.surfaces), pass.sample(mask));
        let target = pass.storage_texture_mut(&mut made, Contents::Overwrite);
        let size_px = screen.size_px;
        pass.body(move |ctx| {
            let own = [
                Bind::Texture(surfaces),
                Bind::TextureArray(mask),
                Bind::TextureArray(target),
                Bind::Uniform(layers.record),
                Bind::Uniform(own),
            ];
            let groups = [
                ctx.bind_group(&self.view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?,
                ctx.bind_group(&self.layout, &own)?,
            ];
            dispatch(&mut ctx.pass, &self.pipeline, &groups, workgroups(size_px, layers));
            Ok(())
        });
        made
    }
}

/// A mask of the frame.
pub(in crate::techniques) fn mask_texture(
    frame: &mut Frame<'_>,
    name: impl shadowgraph_core::Name,
    screen: &SurfaceBuffers,
    layers: Layers,
) -> Texture {
    let [width, height] = screen.size_px;
    frame.create_texture(name, TextureDesc::d2(width, height, MASK_FORMAT).layers(layers.count))
}

/// How many workgroups compute each pixel of each layer.
pub(in crate::techniques) fn workgroups([width, height]: [u32; 2], layers: Layers) -> [u32; 3] {
    [width.div_ceil(WORKGROUP_PX), height.div_ceil(WORKGROUP_PX), layers.count]
}
