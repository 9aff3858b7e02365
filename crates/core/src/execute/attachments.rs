//! The plan's attachments as wgpu's.

use crate::access::{Access, ClearValue};
use crate::plan::{AccessPlan, AttachmentOps, LoadAction, StoreAction};

pub(super) fn color_attachment<'v>(
    access: &AccessPlan,
    view: &'v wgpu::TextureView,
) -> Option<Option<wgpu::RenderPassColorAttachment<'v>>> {
    let (Access::Color(_), Some(ops)) = (access.access, access.ops) else {
        return None;
    };
    let clear = |value| match value {
        ClearValue::Color([r, g, b, a]) => wgpu::Color { r, g, b, a },
        ClearValue::Depth(_) => wgpu::Color::TRANSPARENT,
    };
    let ops = operations(&ops, clear);
    Some(Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops }))
}

pub(super) fn depth_attachment<'v>(
    access: &AccessPlan,
    view: &'v wgpu::TextureView,
) -> Option<wgpu::RenderPassDepthStencilAttachment<'v>> {
    if !matches!(access.access, Access::Depth | Access::DepthRead) {
        return None;
    }
    let clear = |value| match value {
        ClearValue::Depth(depth) => depth,
        ClearValue::Color(_) => 0.0,
    };
    let stencil = view.texture().format().has_stencil_aspect();
    let depth_ops = access.ops.map(|ops| operations(&ops, clear));
    let stencil_ops = access.ops.filter(|_| stencil).map(|ops| operations(&ops, |_| 0));
    Some(wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops })
}

fn operations<V>(ops: &AttachmentOps, clear: impl Fn(ClearValue) -> V) -> wgpu::Operations<V> {
    wgpu::Operations {
        load: match ops.load {
            LoadAction::Clear(value) => wgpu::LoadOp::Clear(clear(value)),
            LoadAction::Load => wgpu::LoadOp::Load,
        },
        store: match ops.store {
            StoreAction::Store => wgpu::StoreOp::Store,
            StoreAction::Discard => wgpu::StoreOp::Discard,
        },
    }
}
