//! Counting texels with values that they should not have, and copying single texels.

use super::{section, uniform};
use crate::desc::Format;
use std::collections::HashMap;
use std::ops::{Range, RangeInclusive};
use wgpu::{TextureDimension, TextureSampleType, TextureViewDimension};

/// Words of the counts of a part: see `COUNTED_*` of `internal.wgsl`.
pub(crate) const COUNT_WORDS: u32 = 4;
/// Words of a copied texel: its place, and the bits of four channels.
pub(crate) const TEXEL_WORDS: u32 = 7;
/// The side of a workgroup that counts, texels.
const WORKGROUP: u32 = 8;

/// How a shader reads a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ImageKind {
    sample_type: TextureSampleType,
    dimension: TextureViewDimension,
    multisampled: bool,
}

impl ImageKind {
    /// Returns how a texture is read: `None` if it cannot be, for a 1D texture, a stencil without depth, and formats with planes.
    pub(crate) fn for_texture(format: Format, dimension: TextureDimension, samples: u32) -> Option<Self> {
        let aspect = format.has_depth_aspect().then_some(wgpu::TextureAspect::DepthOnly);
        let sample_type = match format.sample_type(aspect, None)? {
            TextureSampleType::Float { .. } => TextureSampleType::Float { filterable: false },
            other => other,
        };
        let dimension = match (dimension, samples) {
            (TextureDimension::D1, _) => return None,
            (TextureDimension::D2, 1) => TextureViewDimension::D2Array,
            (TextureDimension::D2, _) => TextureViewDimension::D2,
            (TextureDimension::D3, _) => TextureViewDimension::D3,
        };
        let is_stencil = format.has_stencil_aspect() && !format.has_depth_aspect();
        (!is_stencil).then_some(Self { sample_type, dimension, multisampled: samples > 1 })
    }

    /// Returns whether texels are numbers that can be NaN, or outside of a range.
    pub(crate) fn has_floats(self) -> bool {
        matches!(self.sample_type, TextureSampleType::Float { .. } | TextureSampleType::Depth)
    }

    /// Returns the value of the bits of a channel.
    pub(crate) fn decode(self, bits: u32) -> f64 {
        match self.sample_type {
            TextureSampleType::Uint => f64::from(bits),
            TextureSampleType::Sint => f64::from(bits.cast_signed()),
            _ => f64::from(f32::from_bits(bits)),
        }
    }

    /// Returns the view of some layers of a mip level.
    pub(crate) fn view(self, texture: &wgpu::Texture, mip: u32, layers: &Range<u32>) -> wgpu::TextureView {
        let aspect = match self.sample_type {
            TextureSampleType::Depth => wgpu::TextureAspect::DepthOnly,
            _ => wgpu::TextureAspect::All,
        };
        let layers = match self.dimension {
            TextureViewDimension::D3 => 0..1,
            _ => layers.clone(),
        };
        texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(self.dimension),
            aspect,
            base_mip_level: mip,
            mip_level_count: Some(1),
            base_array_layer: layers.start,
            array_layer_count: Some(layers.end - layers.start),
            ..Default::default()
        })
    }

    fn source(self) -> String {
        let scalar = super::scalar(self.sample_type);
        let is_depth = self.sample_type == TextureSampleType::Depth;
        let (texture, arguments) = match (self.dimension, is_depth) {
            (TextureViewDimension::D3, _) => (format!("texture_3d<{scalar}>"), "at, 0"),
            (TextureViewDimension::D2, true) => {
                ("texture_depth_multisampled_2d".into(), "at.xy, i32(sample)")
            }
            (TextureViewDimension::D2, false) => {
                (format!("texture_multisampled_2d<{scalar}>"), "at.xy, i32(sample)")
            }
            (_, true) => ("texture_depth_2d_array".into(), "at.xy, at.z, 0"),
            (_, false) => (format!("texture_2d_array<{scalar}>"), "at.xy, at.z, 0"),
        };
        let loaded = format!("textureLoad(image, {arguments})");
        let load = match is_depth {
            true => format!("vec4u(bitcast<u32>({loaded}), 0u, 0u, 0u)"),
            false => format!("bitcast<vec4u>({loaded})"),
        };
        let samples = if self.multisampled { "textureNumSamples(image)" } else { "1u" };
        section("values")
            .replace("< SAMPLES", &format!("< {samples}"))
            .replace("image: TEXTURE", &format!("image: {texture}"))
            .replace("return LOAD", &format!("return {load}"))
    }
}

/// A part of a texture that is read, and where its results go. Fields as in `CheckedPart` of `internal.wgsl`.
#[derive(Clone, Debug)]
pub(crate) struct ImagePart {
    /// The first texel that was written, and their number along each side.
    pub(crate) written: [u32; 4],
    /// The size of the mip level that was written.
    pub(crate) written_size: [u32; 2],
    /// The size of the mip level that is read.
    pub(crate) size: [u32; 2],
    pub(crate) layers: u32,
    pub(crate) channels: u32,
    pub(crate) counts: u32,
    pub(crate) copied: u32,
    pub(crate) range: RangeInclusive<f32>,
}

impl ImagePart {
    fn words(&self) -> [u32; 16] {
        let [a, b, c, d] = self.written;
        let ([e, f], [g, h]) = (self.written_size, self.size);
        let [low, high] = [self.range.start(), self.range.end()].map(|value| value.to_bits());
        let Self { layers, channels, counts, copied, .. } = *self;
        [a, b, c, d, e, f, g, h, layers, channels, counts, copied, low, high, 0, 0]
    }
}

/// What is done with a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ValueStep {
    /// Texels are counted.
    Count,
    /// A texel is copied.
    Copy,
}

/// Pipelines by the kind of texture, on one device.
pub(crate) struct ValueChecks {
    device: wgpu::Device,
    kinds: HashMap<ImageKind, KindPipelines>,
}

struct KindPipelines {
    layout: wgpu::BindGroupLayout,
    count: wgpu::ComputePipeline,
    copy: wgpu::ComputePipeline,
}

impl ValueChecks {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self { device: device.clone(), kinds: HashMap::new() }
    }

    pub(crate) fn is_of(&self, device: &wgpu::Device) -> bool {
        self.device == *device
    }

    /// Records a step. `words` is the buffer of all results.
    pub(crate) fn record(
        &mut self,
        pass: &mut wgpu::ComputePass<'_>,
        (kind, view): (ImageKind, &wgpu::TextureView),
        words: &wgpu::Buffer,
        (step, part): (ValueStep, &ImagePart),
    ) {
        let device = &self.device;
        let pipelines = self.kinds.entry(kind).or_insert_with(|| KindPipelines::new(device, kind));
        let block = uniform(device, "value check", &part.words());
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("value check"),
            layout: &pipelines.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(view) },
                wgpu::BindGroupEntry { binding: 1, resource: words.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 2, resource: block.as_entire_binding() },
            ],
        });
        pass.set_bind_group(0, &group, &[]);
        match step {
            ValueStep::Count => {
                let [_, _, width, height] = part.written;
                pass.set_pipeline(&pipelines.count);
                pass.dispatch_workgroups(width.div_ceil(WORKGROUP), height.div_ceil(WORKGROUP), part.layers);
            }
            ValueStep::Copy => {
                pass.set_pipeline(&pipelines.copy);
                pass.dispatch_workgroups(1, 1, 1);
            }
        }
    }
}

impl KindPipelines {
    fn new(device: &wgpu::Device, kind: ImageKind) -> Self {
        let label = Some("value check");
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty,
            count: None,
        };
        let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let image = wgpu::BindingType::Texture {
            sample_type: kind.sample_type,
            view_dimension: kind.dimension,
            multisampled: kind.multisampled,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label,
            entries: &[
                entry(0, image),
                entry(1, buffer(wgpu::BufferBindingType::Storage { read_only: false })),
                entry(2, buffer(wgpu::BufferBindingType::Uniform)),
            ],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label,
            source: wgpu::ShaderSource::Wgsl(kind.source().into()),
        });
        let pipeline = |entry_point| {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label,
                layout: Some(&pipeline_layout),
                module: &module,
                entry_point: Some(entry_point),
                compilation_options: Default::default(),
                cache: None,
            })
        };
        Self { count: pipeline("count"), copy: pipeline("copy"), layout }
    }
}
