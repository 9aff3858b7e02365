//! Objects that both sides of a whole frame draw with: a device, a pipeline for each number of textures, and the caller's
//! two textures.

use crate::frames::chain::{FAN_IN, FORMAT, desc};
use shadowgraph_core::wgpu;

pub(crate) struct Drawing {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    /// Pipelines for one texture, for two, and so on.
    pub(crate) programs: [Program; FAN_IN],
    /// First and last texture of the chain.
    pub(crate) ends: [wgpu::Texture; 2],
    /// Passes cost more on a device with buffers than on one without, and every program has some.
    _buffers: [wgpu::Buffer; 16],
}

pub(crate) struct Program {
    pub(crate) layout: wgpu::BindGroupLayout,
    pub(crate) pipeline: wgpu::RenderPipeline,
}

impl Drawing {
    /// Creates the objects.
    pub(crate) fn new(device: wgpu::Device, queue: wgpu::Queue) -> Self {
        let programs = std::array::from_fn(|index| Program::new(&device, index + 1));
        let ends = [(); 2].map(|()| texture(&device));
        let buffers = std::array::from_fn(|_| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: 4,
                usage: wgpu::BufferUsages::VERTEX,
                mapped_at_creation: false,
            })
        });
        Self { device, queue, programs, ends, _buffers: buffers }
    }

    /// Returns the shader for this many textures.
    pub(crate) fn program(&self, textures: usize) -> &Program {
        &self.programs[textures - 1]
    }
}

impl Program {
    fn new(device: &wgpu::Device, textures: usize) -> Self {
        let declared = |at| format!("@group(0) @binding({at}) var texture_{at}: texture_2d<f32>;\n");
        let loaded = |at| format!(" + textureLoad(texture_{at}, vec2u(at.xy), 0)");
        let mut text: String = (0..textures).map(declared).collect();
        text += "@vertex fn corner(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {\n";
        text += "    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);\n}\n";
        text += "@fragment fn sum(@builtin(position) at: vec4f) -> @location(0) vec4f {\n    return vec4f()";
        text.extend((0..textures).map(loaded));
        text += ";\n}\n";
        let source = wgpu::ShaderSource::Wgsl(text.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: None,
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                buffers: &[],
            },
            primitive: Default::default(),
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: None,
                compilation_options: Default::default(),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        Self { layout: pipeline.get_bind_group_layout(0), pipeline }
    }
}

/// Creates a texture for the chain.
pub(crate) fn texture(device: &wgpu::Device) -> wgpu::Texture {
    let desc = desc();
    device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: desc.size,
        mip_level_count: desc.mip_levels,
        sample_count: desc.samples,
        dimension: desc.dimension,
        format: desc.format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    })
}
