//! A debug mode: reused memory and discarded attachments are filled with conspicuous values, so that a read of contents
//! that nobody wrote is visible immediately.

use crate::access::ClearValue;
use crate::context::Recording;
use crate::declaration::Origin;
use crate::handle::PassId;
use crate::plan::StoreAction;
use crate::pool::{PhysicalResource, ViewUsage, create_view, poison_value};
use crate::subresource::{Aspect, Subresource};
use wgpu::{TextureDimension, TextureUsages};

impl Recording<'_> {
    /// Fills the slots of resources whose lifetime begins in this step.
    pub(super) fn poison_first_uses(&self, step: usize, encoder: &mut wgpu::CommandEncoder) {
        let begins = |steps: Option<(u32, u32)>| steps.is_some_and(|(first, _)| first as usize == step);
        for (fate, object) in self.plan.placements.iter().zip(&self.resolved.objects) {
            match object {
                _ if fate.slot.is_none() || !begins(fate.steps) => {}
                Some(PhysicalResource::Texture(texture)) => {
                    self.fill_texture(encoder, texture, Subresource::FULL)
                }
                Some(PhysicalResource::Buffer(buffer)) => self.fill_buffer(encoder, buffer),
                None => {}
            }
        }
    }

    /// Fills the attachments that the step discarded.
    pub(super) fn poison_discards(&self, passes: &[PassId], encoder: &mut wgpu::CommandEncoder) {
        let decl = &self.plan.decl;
        for index in passes.iter().flat_map(|&pass| decl.access_range(pass)) {
            let access = &decl.accesses[index];
            let discarded = self.plan.ops[index].is_some_and(|ops| ops.store == StoreAction::Discard);
            if discarded
                && decl.resource(access.resource).origin == Origin::Transient
                && let Ok(texture) = self.texture(access.resource)
            {
                self.fill_texture(encoder, texture, decl.subresource(access));
            }
        }
    }

    /// Fills the mips, layers (slices of a volume) and aspect of a part.
    fn fill_texture(&self, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture, part: Subresource) {
        let usage = texture.usage();
        let (first, end) = part.mips.unwrap_or((0, texture.mip_level_count()));
        for mip in first..end {
            let size = texture.size().mip_level_size(mip, texture.dimension());
            let (first, end) = part.layers.unwrap_or((0, size.depth_or_array_layers));
            for layer in first..end {
                if usage.contains(TextureUsages::TRANSIENT_ATTACHMENT) {
                } else if usage.contains(TextureUsages::RENDER_ATTACHMENT) {
                    clear_layer(encoder, texture, mip, layer, part.aspect);
                } else if usage.contains(TextureUsages::COPY_DST) {
                    self.fill_by_copy(encoder, texture, mip, layer);
                }
            }
        }
    }

    fn fill_buffer(&self, encoder: &mut wgpu::CommandEncoder, buffer: &wgpu::Buffer) {
        let source = self.pool.caches().poison_buffer.get(self.device, 0);
        let mut start = 0;
        while start < buffer.size() {
            let bytes = (buffer.size() - start).min(source.size());
            encoder.copy_buffer_to_buffer(&source, 0, buffer, start, bytes);
            start += bytes;
        }
    }

    /// Fills a texture that is not renderable.
    fn fill_by_copy(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        mip: u32,
        layer: u32,
    ) {
        let format = texture.format();
        let size = texture.size().mip_level_size(mip, texture.dimension()).physical_size(format);
        let ((width, height), Some(block)) = (format.block_dimensions(), format.block_copy_size(None)) else {
            return;
        };
        let (row, rows) = (size.width / width * block, size.height / height);
        let row = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let source = self.pool.caches().poison_buffer.get(self.device, u64::from(row) * u64::from(rows));
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let origin = wgpu::Origin3d { x: 0, y: 0, z: layer };
        let target =
            wgpu::TexelCopyTextureInfo { texture, mip_level: mip, origin, aspect: wgpu::TextureAspect::All };
        let one = wgpu::Extent3d { depth_or_array_layers: 1, ..size };
        encoder.copy_buffer_to_texture(wgpu::TexelCopyBufferInfo { buffer: &source, layout }, target, one);
    }
}

/// Clears one layer of one mip.
fn clear_layer(
    encoder: &mut wgpu::CommandEncoder,
    texture: &wgpu::Texture,
    mip: u32,
    layer: u32,
    aspect: Aspect,
) {
    let format = texture.format();
    let view = create_view(texture, Subresource::FULL.mip(mip).layer(layer), ViewUsage::Attachment);
    let (color, depth, stencil) = match poison_value(format) {
        ClearValue::Color([r, g, b, a]) => (Some(wgpu::Color { r, g, b, a }), None, None),
        ClearValue::Depth(depth) => (None, Some(depth), None),
        ClearValue::DepthStencil(depth, stencil) => (None, Some(depth), Some(stencil)),
    };
    let color_attachment = [color.map(|color| wgpu::RenderPassColorAttachment {
        view: &view,
        depth_slice: (texture.dimension() == TextureDimension::D3).then_some(layer),
        resolve_target: None,
        ops: clear(color),
    })];
    let depth = depth.filter(|_| format.has_depth_aspect() && aspect != Aspect::Stencil);
    let stencil = stencil.filter(|_| format.has_stencil_aspect() && aspect != Aspect::Depth);
    let depth_stencil_attachment = wgpu::RenderPassDepthStencilAttachment {
        view: &view,
        depth_ops: depth.map(clear),
        stencil_ops: stencil.map(clear),
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("poison"),
        color_attachments: if color.is_some() { &color_attachment } else { &[] },
        depth_stencil_attachment: color.is_none().then_some(depth_stencil_attachment),
        ..Default::default()
    });
}

fn clear<V>(value: V) -> wgpu::Operations<V> {
    wgpu::Operations { load: wgpu::LoadOp::Clear(value), store: wgpu::StoreOp::Store }
}
