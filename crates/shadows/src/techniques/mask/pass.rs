//! Passes over a screen mask.

use shadowgraph_core::{Bind, Buffer, Contents, Frame, Texture, TextureDesc, Uniform};
use shadowgraph_shaders::compose;

use super::{MASK, TARGET, WORKGROUP_PX};
use crate::error::Error;
use crate::technique::binding::{FLOAT_MAP, STORAGE, UNIFORM};
use crate::technique::{GpuStruct, MASK_FORMAT, MAX_MASK_LIGHTS, MaskLayers, SurfaceBuffers, layout};
use crate::techniques::compute::{dispatch, pipeline, shader};

/// The layers of a mask on the GPU.
#[derive(Clone, Copy)]
pub(in crate::techniques) struct Layers {
    /// The uniform block `MaskLayers` of `layers.wgsl`.
    pub(in crate::techniques) block: Uniform,
    /// Number of layers.
    pub(in crate::techniques) count: u32,
}

impl Layers {
    /// Uploads the layers.
    pub(in crate::techniques) fn new(frame: &mut Frame<'_>, layers: &MaskLayers) -> Self {
        let mut lights = [[NO_LIGHT; 4]; MAX_MASK_LIGHTS];
        for (channels, layer) in lights.iter_mut().zip(layers.iter()) {
            channels[..layer.len()].copy_from_slice(layer);
            if let [_] = layer {
                channels[1] = COLORED;
            }
        }
        let count = layers.count();
        let block = [bytemuck::bytes_of(&[count, 0, 0, 0]), bytemuck::cast_slice(&lights)].concat();
        Self { block: frame.uniform(&block), count }
    }
}

/// `NO_LIGHT` and `COLORED` of `layers.wgsl`.
const NO_LIGHT: u32 = u32::MAX;
const COLORED: u32 = u32::MAX - 1;

/// A compute pass that computes one screen mask from another. It also reads the surface buffers and a separate
/// uniform block.
pub(in crate::techniques) struct MaskPass {
    name: &'static str,
    view_layout: wgpu::BindGroupLayout,
    /// Group 1 of a pass that reads the shadow views; its own group is then group 2.
    shadow_views_layout: Option<wgpu::BindGroupLayout>,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl MaskPass {
    /// Creates the pipeline for an entry point of a built-in file. `own` is the struct of its uniform block. `has_views`: it reads
    /// the shadow views and lights.
    pub(in crate::techniques) fn new(
        device: &wgpu::Device,
        name: &'static str,
        (file, entry): (&str, &str),
        own: &GpuStruct,
        has_views: bool,
    ) -> Result<Self, Error> {
        let view_layout = layout(device, "view", &[UNIFORM, STORAGE]);
        let shadow_views_layout = has_views.then(|| layout(device, "shadow views", &[STORAGE; 2]));
        let own_layout = layout(device, name, &[FLOAT_MAP, MASK, TARGET, UNIFORM, UNIFORM]);
        let module = compose(file, &[])?;
        own.check(&module)?;
        let shader = shader(device, file, module);
        let groups = [Some(&view_layout), shadow_views_layout.as_ref(), Some(&own_layout)];
        let groups: Vec<_> = groups.into_iter().flatten().collect();
        let pipeline = pipeline(device, &shader, entry, &groups);
        Ok(Self { name, view_layout, shadow_views_layout, layout: own_layout, pipeline })
    }

    /// Adds the pass, and returns the new mask. `shadow_views`: the buffers of shadow views and lights, for
    /// a pass that reads them.
    pub(in crate::techniques) fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        buffers: &SurfaceBuffers,
        mask: &Texture,
        layers: Layers,
        own: Uniform,
        shadow_views: Option<&[Buffer; 2]>,
    ) -> Texture {
        let mut output = mask_texture(frame, format_args!("shadow mask, {}", self.name), buffers, layers);
        let mut pass = frame.compute_pass(self.name);
        let (view, lights) = (pass.uniform_buffer(&buffers.view), pass.storage_buffer(&buffers.lights));
        let shadow_views = self.shadow_views_layout.as_ref().zip(shadow_views);
        let shadow_views = shadow_views
            .map(|(layout, buffers)| (layout, buffers.each_ref().map(|buffer| pass.storage_buffer(buffer))));
        let (surfaces, mask) = (pass.sample(&buffers.surfaces), pass.sample(mask));
        let target = pass.storage_texture_mut(&mut output, Contents::Overwrite);
        let size_px = buffers.size_px;
        pass.body(move |ctx| {
            let own = [
                Bind::Texture(surfaces),
                Bind::TextureArray(mask),
                Bind::TextureArray(target),
                Bind::Uniform(layers.block),
                Bind::Uniform(own),
            ];
            let mut groups =
                vec![ctx.bind_group(&self.view_layout, &[Bind::Buffer(view), Bind::Buffer(lights)])?];
            if let Some((layout, buffers)) = shadow_views {
                groups.push(ctx.bind_group(layout, &buffers.map(Bind::Buffer))?);
            }
            groups.push(ctx.bind_group(&self.layout, &own)?);
            dispatch(&mut ctx.pass, &self.pipeline, &groups, workgroups(size_px, layers));
            Ok(())
        });
        output
    }
}

/// Creates a mask of the frame.
pub(in crate::techniques) fn mask_texture(
    frame: &mut Frame<'_>,
    name: impl shadowgraph_core::Name,
    buffers: &SurfaceBuffers,
    layers: Layers,
) -> Texture {
    let [width, height] = buffers.size_px;
    frame.create_texture(name, TextureDesc::d2(width, height, MASK_FORMAT).layers(layers.count))
}

/// Returns the number of workgroups that cover each pixel of each layer.
pub(in crate::techniques) fn workgroups([width, height]: [u32; 2], layers: Layers) -> [u32; 3] {
    [width.div_ceil(WORKGROUP_PX), height.div_ceil(WORKGROUP_PX), layers.count]
}
