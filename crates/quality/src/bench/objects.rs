//! Helpers that create the wgpu objects of the hand-written passes.

use std::num::NonZeroU64;

use shadowgraph_core::Format;
use wgpu::{BindingResource, BufferUsages, TextureUsages};

/// Creates a storage buffer that is written each frame.
pub(super) fn buffer(device: &wgpu::Device, size: u64) -> wgpu::Buffer {
    let usage = BufferUsages::STORAGE | BufferUsages::UNIFORM | BufferUsages::COPY_DST;
    device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
}

/// Creates a texture to draw into, with additional usages.
pub(super) fn attachment(
    device: &wgpu::Device,
    [width, height]: [u32; 2],
    format: Format,
    usage: TextureUsages,
) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: usage | TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Creates the comparison sampler of shadow maps.
pub(super) fn comparison_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        compare: Some(wgpu::CompareFunction::GreaterEqual),
        ..Default::default()
    })
}

/// Returns the binding of a range of a buffer, used with dynamic offsets.
pub(super) fn range(buffer: &wgpu::Buffer, bytes: u32) -> BindingResource<'_> {
    BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size: NonZeroU64::new(bytes.into()) })
}

/// Creates a bind group of the entries, at bindings 0, 1, 2 and so on.
pub(super) fn group<'r>(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    entries: impl IntoIterator<Item = BindingResource<'r>>,
) -> wgpu::BindGroup {
    let entries = (0..).zip(entries);
    let entries: Vec<_> =
        entries.map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// Begins a pass: a colour target and its clear value, a depth target and whether it is cleared and written
/// (else only tested).
pub(super) fn begin<'e>(
    encoder: &'e mut wgpu::CommandEncoder,
    label: &str,
    color: Option<(&wgpu::TextureView, [f64; 4])>,
    depth: Option<(&wgpu::TextureView, bool)>,
) -> wgpu::RenderPass<'e> {
    let store = wgpu::StoreOp::Store;
    let color = color.map(|(view, [r, g, b, a])| wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }), store },
    });
    let depth = depth.map(|(view, writes)| wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: writes.then_some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store }),
        stencil_ops: None,
    });
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some(label),
        color_attachments: if color.is_some() { std::slice::from_ref(&color) } else { &[] },
        depth_stencil_attachment: depth,
        ..Default::default()
    })
}
