//! A device with helpers for tests.

use crate::execute::ReadBack;
use crate::read_back::TexturePart;
use crate::test_device::{drawing, noop, valid};
use crate::{Aspect, Bind, Error, Executed, Format, Frame, Graph, RenderContext, TextureDesc};

pub(super) struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    /// Whether the device draws.
    pub(super) draws: bool,
    shaders: wgpu::ShaderModule,
}

impl Gpu {
    pub(super) fn noop() -> Self {
        Self::new(noop(), false)
    }

    pub(super) fn drawing() -> Option<Self> {
        drawing().map(|device| Self::new(device, true))
    }

    /// Returns the device that only validates, and one that draws if there is one.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        [Some(Self::noop()), Self::drawing()].into_iter().flatten()
    }

    pub(super) fn new((device, queue): (wgpu::Device, wgpu::Queue), draws: bool) -> Self {
        let shaders = device.create_shader_module(wgpu::include_wgsl!("../../../tests/execute.wgsl"));
        Self { device, queue, draws, shaders }
    }

    /// Records and submits, and fails the test on a validation error of wgpu.
    pub(super) fn try_run(&self, graph: &mut Graph, frame: Frame<'_>) -> Result<Executed, Error> {
        valid(&self.device, || {
            let mut encoder = self.encoder();
            let executed = graph.compile(frame)?.execute(graph, &self.device, &mut encoder)?;
            self.queue.submit([encoder.finish()]);
            Ok(executed)
        })
    }

    pub(super) fn run(&self, graph: &mut Graph, frame: Frame<'_>) -> Executed {
        self.try_run(graph, frame).unwrap()
    }

    pub(super) fn encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&Default::default())
    }

    /// Returns the texels of one mip of one layer (or slice), 4 bytes each; none on a device that does not draw.
    pub(super) fn texels(&self, texture: &wgpu::Texture, mip: u32, layer: u32) -> Vec<u32> {
        let mut encoder = self.encoder();
        let back = self.read_texels(&mut encoder, texture, (mip, layer));
        let words = self.words_of(back, encoder);
        if self.draws { words } else { Vec::new() }
    }

    /// Records a copy of one mip of one layer.
    pub(super) fn read_texels(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        (mip, layer): (u32, u32),
    ) -> ReadBack {
        let part =
            TexturePart { mip, layers: layer..layer + 1, aspect: wgpu::TextureAspect::All, rect: None };
        ReadBack::texture(&self.device, encoder, "texture", texture, &part).unwrap()
    }

    /// Compares all texels of the first mip and layer with one number.
    pub(super) fn assert_filled(&self, texture: &wgpu::Texture, number: u32) {
        let texels = self.texels(texture, 0, 0);
        assert!(texels.iter().all(|&texel| texel == number), "{texels:?} instead of {number}");
    }

    pub(super) fn words(&self, buffer: &wgpu::Buffer) -> Vec<u32> {
        let mut encoder = self.encoder();
        let back = ReadBack::buffer(&self.device, &mut encoder, "buffer", buffer, 0..buffer.size()).unwrap();
        self.words_of(back, encoder)
    }

    fn words_of(&self, back: ReadBack, encoder: wgpu::CommandEncoder) -> Vec<u32> {
        valid(&self.device, || self.queue.submit([encoder.finish()]));
        let bytes = back.wait(&self.device).unwrap();
        bytes.chunks_exact(4).map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect()
    }

    pub(super) fn texture(&self, desc: TextureDesc, usage: wgpu::TextureUsages) -> wgpu::Texture {
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: desc.size,
            mip_level_count: desc.mip_levels,
            sample_count: desc.samples,
            dimension: desc.dimension,
            format: desc.format,
            usage,
            view_formats: &[],
        })
    }

    /// Creates a draw over the whole viewport with the fragment stage `entry` into one colour attachment.
    pub(super) fn draw(&self, entry: &'static str, format: Format) -> Draw {
        self.draw_with(entry, format.into(), None, 1)
    }

    /// Creates the same draw with blending, depth test or samples.
    pub(super) fn draw_with(
        &self,
        entry: &'static str,
        color: wgpu::ColorTargetState,
        depth_stencil: Option<wgpu::DepthStencilState>,
        samples: u32,
    ) -> Draw {
        let pipeline = self.pipeline((&self.shaders, entry), None, (color, depth_stencil, samples));
        let bare = ["seven", "place", "white"].contains(&entry);
        let layout = (!bare).then(|| pipeline.get_bind_group_layout(0));
        Draw { pipeline, layout, index: 0 }
    }

    /// Creates a draw with a uniform block in group 5 and no other bindings.
    pub(super) fn draw_with_far_group(&self) -> Draw {
        let layout = self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let whole = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[None, None, None, None, None, Some(&layout)],
            immediate_size: 0,
        });
        let module = self.device.create_shader_module(wgpu::include_wgsl!("../../../tests/far_group.wgsl"));
        let pipeline = self.pipeline((&module, "far_number"), Some(&whole), (NUMBERS.into(), None, 1));
        Draw { pipeline, layout: Some(layout), index: 5 }
    }

    fn pipeline(
        &self,
        (module, entry): (&wgpu::ShaderModule, &'static str),
        layout: Option<&wgpu::PipelineLayout>,
        (color, depth_stencil, samples): (wgpu::ColorTargetState, Option<wgpu::DepthStencilState>, u32),
    ) -> wgpu::RenderPipeline {
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry),
            layout,
            vertex: wgpu::VertexState {
                module,
                entry_point: Some("everywhere"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil,
            multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(entry),
                compilation_options: Default::default(),
                targets: &[Some(color)],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    pub(super) fn compute(&self, entry: &'static str) -> Compute {
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &self.shaders,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            cache: None,
        });
        Compute { layout: pipeline.get_bind_group_layout(0), pipeline }
    }
}

pub(super) struct Draw {
    pub(super) pipeline: wgpu::RenderPipeline,
    layout: Option<wgpu::BindGroupLayout>,
    index: u32,
}

impl Draw {
    /// Sets the pipeline and its group, and draws.
    pub(super) fn record(&self, ctx: &mut RenderContext<'_>, entries: &[Bind<'_>]) -> Result<(), Error> {
        if let Some(layout) = &self.layout {
            let group = ctx.bind_group(layout, entries)?;
            ctx.pass.set_bind_group(self.index, &group, &[]);
        }
        self.record_without_bindings(ctx);
        Ok(())
    }

    /// Draws with the groups that are set.
    pub(super) fn record_without_bindings(&self, ctx: &mut RenderContext<'_>) {
        ctx.pass.set_pipeline(&self.pipeline);
        ctx.pass.draw(0..3, 0..1);
    }
}

pub(super) struct Compute {
    pub(super) pipeline: wgpu::ComputePipeline,
    pub(super) layout: wgpu::BindGroupLayout,
}

impl Compute {
    pub(super) fn record(
        &self,
        ctx: &mut crate::ComputeContext<'_>,
        entries: &[Bind<'_>],
        groups: u32,
    ) -> Result<(), Error> {
        let group = ctx.bind_group(&self.layout, entries)?;
        ctx.pass.set_pipeline(&self.pipeline);
        ctx.pass.set_bind_group(0, &group, &[]);
        ctx.pass.dispatch_workgroups(groups, 1, 1);
        Ok(())
    }
}

pub(super) const NUMBERS: Format = Format::R32Uint;

/// Describes a square texture of numbers.
pub(super) fn square(side: u32) -> TextureDesc {
    TextureDesc::d2(side, side, NUMBERS)
}

pub(super) fn number(number: u32) -> [u8; 16] {
    let mut block = [0; 16];
    block[..4].copy_from_slice(&number.to_le_bytes());
    block
}

/// Describes a depth test.
pub(super) fn depth_test(
    format: Format,
    compare: wgpu::CompareFunction,
    write: bool,
) -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: format.has_depth_aspect().then_some(write),
        depth_compare: format.has_depth_aspect().then_some(compare),
        stencil: Default::default(),
        bias: Default::default(),
    }
}

pub(super) fn aspect(aspect: Aspect) -> crate::Subresource {
    crate::Subresource::FULL.aspect(aspect)
}
