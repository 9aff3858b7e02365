//! Draws that clear and copy depth in parts of a map.

use std::borrow::Cow;

use bytemuck::{Pod, Zeroable};
use shadowgraph_shaders::compose;

use crate::error::Error;
use crate::technique::binding::{DEPTH_MAP, UNIFORM};
use crate::technique::layout;

/// The pipelines for maps of one format.
pub(super) struct Restore {
    pub(super) layout: wgpu::BindGroupLayout,
    /// Sets depth to the far end.
    pub(super) clear: wgpu::RenderPipeline,
    /// Copies a tile of the store.
    pub(super) copy: wgpu::RenderPipeline,
}

/// `Restore` of `restore.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub(super) struct RestoreBlock {
    pub(super) tile_px: [u32; 4],
    pub(super) wrap_px: [u32; 2],
    pub(super) padding: [u32; 2],
}

impl Restore {
    pub(super) fn new(device: &wgpu::Device, format: wgpu::TextureFormat) -> Result<Self, Error> {
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("restore.wgsl"),
            source: wgpu::ShaderSource::Naga(Cow::Owned(compose("restore.wgsl", &[])?)),
        });
        let layout = layout(device, "restore", &[DEPTH_MAP, UNIFORM]);
        let make = |fragment| pipeline(device, &shader, format, &layout, fragment);
        let (clear, copy) = (make(None), make(Some("fs_restore")));
        Ok(Self { layout, clear, copy })
    }
}

fn pipeline(
    device: &wgpu::Device,
    shader: &wgpu::ShaderModule,
    format: wgpu::TextureFormat,
    layout: &wgpu::BindGroupLayout,
    fragment: Option<&str>,
) -> wgpu::RenderPipeline {
    let groups = [fragment.map(|_| layout)];
    let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("restore"),
        bind_group_layouts: &groups[..usize::from(fragment.is_some())],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(fragment.unwrap_or("clear depth")),
        layout: Some(&pipeline_layout),
        vertex: wgpu::VertexState {
            module: shader,
            entry_point: Some("vs_restore"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Always),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: fragment.map(|entry| wgpu::FragmentState {
            module: shader,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn the_uniform_block_has_the_same_layout_in_wgsl_and_rust() {
        let module = compose("restore.wgsl", &[]).unwrap();
        let (_, ty) = module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("Restore")).unwrap();
        let shadowgraph_shaders::naga::TypeInner::Struct { members, span } = &ty.inner else { panic!() };
        assert_eq!(*span as usize, size_of::<RestoreBlock>());
        assert_eq!(members[1].offset as usize, std::mem::offset_of!(RestoreBlock, wrap_px));
    }
}
