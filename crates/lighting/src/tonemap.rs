//! From scene-linear light to a picture.

use std::borrow::Cow;

use shadowgraph_core::{Bind, Contents, Format, Frame, Texture};

use crate::Error;

/// The filmic tonemap: one fullscreen pass into an sRGB target.
pub struct Tonemap {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

impl Tonemap {
    /// Makes the pipeline for a target of `format`, which must be an sRGB format.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(device: &wgpu::Device, format: Format) -> Result<Self, Error> {
        let module = shadowgraph_shaders::compose("tonemap.wgsl", &[])?;
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("tonemap.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
        });
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("tonemap"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: false },
                    view_dimension: wgpu::TextureViewDimension::D2,
                    multisampled: false,
                },
                count: None,
            }],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("tonemap"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("tonemap"),
            layout: Some(&pipeline_layout),
            vertex: wgpu::VertexState {
                module: &shader,
                entry_point: Some("vs_tonemap"),
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &shader,
                entry_point: Some("fs_tonemap"),
                compilation_options: Default::default(),
                targets: &[Some(format.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Ok(Self { layout, pipeline })
    }

    /// Returns the pipeline, for a pass that is recorded without the graph: three vertices and no buffers.
    pub fn pipeline(&self) -> &wgpu::RenderPipeline {
        &self.pipeline
    }

    /// Returns the layout of group 0: the texture of light.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// Adds the pass that covers `target` with the picture of `light`, which is as large as the target.
    pub fn add_to<'f>(&'f self, frame: &mut Frame<'f>, light: &Texture, target: &mut Texture) {
        let mut pass = frame.render_pass("tonemap");
        let light = pass.sample(light);
        pass.color(target, Contents::Cover);
        pass.body(move |ctx| {
            let group = ctx.bind_group(&self.layout, &[Bind::Texture(light)])?;
            ctx.pass.set_pipeline(&self.pipeline);
            ctx.pass.set_bind_group(0, &group, &[]);
            ctx.pass.draw(0..3, 0..1);
            ctx.note_draws(1);
            Ok(())
        });
    }
}
