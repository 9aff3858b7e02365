//! Resampling a texture into one of another size, so that a history keeps its contents after a resize.

use super::{module, scalar, section, uniform, vertex};
use crate::desc::{Format, TextureDesc};
use std::collections::HashMap;
use wgpu::{TextureDimension, TextureSampleType, TextureUsages};

/// Reason why a texture cannot be resampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ResampleError {
    /// No shader can write all of the format: it has a stencil aspect, is compressed or is not renderable.
    Format,
    /// More than one sample per texel.
    Samples,
    /// A 1D or 3D texture.
    Dimension,
    /// The source lacks `TEXTURE_BINDING` or the target `RENDER_ATTACHMENT`.
    Usage,
    /// Source and target differ in more than width, height and mips.
    Different,
}

/// Checks that textures of this shape can be resampled, if they are created with `TEXTURE_BINDING` and
/// `RENDER_ATTACHMENT`.
///
/// # Errors
/// The reason why not. Formats that only the adapter supports count as not renderable, since the device does not report
/// them.
pub(crate) fn can_resample(desc: &TextureDesc, features: wgpu::Features) -> Result<(), ResampleError> {
    sample_type(desc.format, desc.samples, desc.dimension, features)?;
    let needed = TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT;
    let allowed = desc.format.guaranteed_format_features(features).allowed_usages;
    if allowed.contains(needed) { Ok(()) } else { Err(ResampleError::Format) }
}

/// Returns how a shader samples such a texture.
fn sample_type(
    format: Format,
    samples: u32,
    dimension: TextureDimension,
    features: wgpu::Features,
) -> Result<TextureSampleType, ResampleError> {
    match (format.sample_type(None, Some(features)), samples, dimension) {
        (_, _, TextureDimension::D1 | TextureDimension::D3) => Err(ResampleError::Dimension),
        (_, 2.., _) => Err(ResampleError::Samples),
        (Some(sample_type), ..) if !format.has_stencil_aspect() => Ok(sample_type),
        _ => Err(ResampleError::Format),
    }
}

/// Resamples textures on one device, with one pipeline per format.
#[derive(Default)]
pub(crate) struct Resampler {
    draws: HashMap<Format, Draw>,
}

impl Resampler {
    /// Records passes that fill all mips and layers of `target` with the contents of `source`, scaled.
    ///
    /// Filterable formats are filtered bilinearly, which skips texels when shrinking to less than half; integers,
    /// unfilterable floats and depth use the nearest texel. A mip is resampled from the same mip of the source, or from
    /// its last one.
    ///
    /// # Errors
    /// The reason why it is not possible; nothing is recorded then.
    pub(crate) fn record(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        source: &wgpu::Texture,
        target: &wgpu::Texture,
    ) -> Result<(), ResampleError> {
        let format = target.format();
        let sample_type = sample_type(format, target.sample_count(), target.dimension(), device.features())?;
        check_pair(source, target)?;
        let draw = self.draws.entry(format).or_insert_with(|| Draw::new(device, format, sample_type));
        for mip in 0..target.mip_level_count() {
            let size = target.size().mip_level_size(mip, target.dimension());
            let size = uniform(device, "resample", &[size.width, size.height]);
            let source_mip = mip.min(source.mip_level_count() - 1);
            for layer in 0..target.depth_or_array_layers() {
                let group = draw.group(device, &view(source, source_mip, layer), &size);
                let mut pass = open_pass(encoder, &view(target, mip, layer));
                pass.set_pipeline(&draw.pipeline);
                pass.set_bind_group(0, &group, &[]);
                pass.draw(0..3, 0..1);
            }
        }
        Ok(())
    }
}

fn check_pair(source: &wgpu::Texture, target: &wgpu::Texture) -> Result<(), ResampleError> {
    let shape = |texture: &wgpu::Texture| {
        (texture.format(), texture.dimension(), texture.sample_count(), texture.depth_or_array_layers())
    };
    if shape(source) != shape(target) {
        return Err(ResampleError::Different);
    }
    let bound = source.usage().contains(TextureUsages::TEXTURE_BINDING);
    let drawn = target.usage().contains(TextureUsages::RENDER_ATTACHMENT);
    if bound && drawn { Ok(()) } else { Err(ResampleError::Usage) }
}

/// Returns the view of one mip and layer.
pub(super) fn view(texture: &wgpu::Texture, mip: u32, layer: u32) -> wgpu::TextureView {
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2),
        base_mip_level: mip,
        mip_level_count: Some(1),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}

struct Draw {
    pipeline: wgpu::RenderPipeline,
    /// `None` for formats that cannot be filtered.
    sampler: Option<wgpu::Sampler>,
}

impl Draw {
    fn new(device: &wgpu::Device, format: Format, sample_type: TextureSampleType) -> Self {
        let filtered = sample_type == TextureSampleType::Float { filterable: true };
        let sampler = filtered.then(|| {
            device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("resample"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            })
        });
        Self { pipeline: pipeline(device, format, sample_type), sampler }
    }

    fn group(
        &self,
        device: &wgpu::Device,
        source: &wgpu::TextureView,
        size: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        let mut entries = vec![
            wgpu::BindGroupEntry { binding: 0, resource: size.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(source) },
        ];
        entries.extend(self.sampler.as_ref().map(|sampler| wgpu::BindGroupEntry {
            binding: 2,
            resource: wgpu::BindingResource::Sampler(sampler),
        }));
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("resample"),
            layout: &self.pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }
}

/// Opens a pass on one mip and layer, whose contents are discarded.
pub(super) fn open_pass<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    target: &wgpu::TextureView,
) -> wgpu::RenderPass<'e> {
    let depth = target.texture().format().is_depth_stencil_format();
    let color = [Some(wgpu::RenderPassColorAttachment {
        view: target,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        },
    })];
    let depth_stencil = wgpu::RenderPassDepthStencilAttachment {
        view: target,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
        stencil_ops: None,
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("resample"),
        color_attachments: if depth { &[] } else { &color },
        depth_stencil_attachment: depth.then_some(depth_stencil),
        ..Default::default()
    })
}

fn pipeline(device: &wgpu::Device, format: Format, sample_type: TextureSampleType) -> wgpu::RenderPipeline {
    let depth = sample_type == TextureSampleType::Depth;
    let last_section = match sample_type {
        TextureSampleType::Depth => "depth",
        TextureSampleType::Float { filterable: true } => "filtered",
        _ => "nearest",
    };
    let fragment =
        [section("resample"), &section(last_section).replace("SCALAR", scalar(sample_type))].concat();
    let module = module(device, "resample", &fragment);
    let color = [Some(format.into())];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("resample"),
        // The layout is derived from the shader; no group is shared between pipelines.
        layout: None,
        vertex: vertex(&module),
        primitive: Default::default(),
        depth_stencil: depth.then(|| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: if depth { &[] } else { &color },
        }),
        multiview_mask: None,
        cache: None,
    })
}
