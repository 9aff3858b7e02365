//! The attachments of a plan, as wgpu takes them.

use crate::access::{Access, ClearValue};
use crate::context::Recording;
use crate::desc::{Format, ResourceDesc};
use crate::device::MAX_COLOR_ATTACHMENTS;
use crate::error::Error;
use crate::handle::PassId;
use crate::internal::Targets;
use crate::plan::{AttachmentOps, LoadAction, Plan, StoreAction};
use crate::subresource::Aspect;
use arrayvec::ArrayVec;

pub(super) type ColorAttachments<'v> =
    ArrayVec<Option<wgpu::RenderPassColorAttachment<'v>>, MAX_COLOR_ATTACHMENTS>;

/// Finds the colour attachments of the passes from `first` to `last`, which share a render pass: the first pass loads, the
/// last one stores and resolves.
pub(super) fn color_attachments<'a>(
    recording: &'a Recording<'a>,
    first: PassId,
    last: PassId,
    colors: &mut ColorAttachments<'a>,
) -> Result<(), Error> {
    let decl = &recording.plan.decl;
    let mut ends = decl.access_range(last);
    for index in decl.access_range(first) {
        let access = &decl.accesses[index];
        let (Access::Color(color), Some(begin)) = (access.access, recording.attachment_ops(index)) else {
            continue;
        };
        let same = |&index: &usize| decl.accesses[index].access == access.access;
        let end = if first == last { None } else { ends.find(same) };
        let end = end.and_then(|index| recording.plan.ops[index]).unwrap_or(begin);
        let volume = match decl.resource(access.resource).desc {
            ResourceDesc::Texture(desc) => desc.dimension == wgpu::TextureDimension::D3,
            ResourceDesc::Buffer(_) => false,
        };
        let slice = decl.subresource(access).layers.map_or(0, |(first, _)| first);
        while colors.len() <= color as usize {
            colors.push(None);
        }
        colors[color as usize] = Some(wgpu::RenderPassColorAttachment {
            view: recording.view(index)?,
            depth_slice: volume.then_some(slice),
            resolve_target: None,
            ops: operations(&begin, &end, |value| match value {
                ClearValue::Color([r, g, b, a]) => wgpu::Color { r, g, b, a },
                ClearValue::Depth(_) | ClearValue::DepthStencil(..) => wgpu::Color::TRANSPARENT,
            }),
        });
    }
    for index in decl.access_range(last) {
        if let Access::Resolve(color) = decl.accesses[index].access
            && let Some(Some(attachment)) = colors.get_mut(color as usize)
        {
            attachment.resolve_target = Some(recording.view(index)?);
        }
    }
    Ok(())
}

/// Finds the depth attachment of the passes from `first` to `last`.
pub(super) fn depth_attachment<'a>(
    recording: &'a Recording<'a>,
    first: PassId,
    last: PassId,
) -> Result<Option<wgpu::RenderPassDepthStencilAttachment<'a>>, Error> {
    let (plan, decl) = (recording.plan, &recording.plan.decl);
    let depth = |&index: &usize| matches!(decl.accesses[index].access, Access::Depth | Access::DepthRead);
    let Some(index) = decl.access_range(first).find(depth) else { return Ok(None) };
    let access = &decl.accesses[index];
    let view = recording.view(index)?;
    let begin = recording.attachment_ops(index);
    let end = decl.access_range(last).find(depth).and_then(|index| plan.ops[index]).or(begin);
    let (has_depth, has_stencil) = match decl.resource(access.resource).desc {
        ResourceDesc::Texture(desc) => (desc.format.has_depth_aspect(), desc.format.has_stencil_aspect()),
        ResourceDesc::Buffer(_) => (false, false),
    };
    let aspect = decl.subresource(access).aspect;
    let ops = begin.zip(end);
    let depth_ops = ops.filter(|_| has_depth && aspect != Aspect::Stencil).map(|(begin, end)| {
        operations(&begin, &end, |value| match value {
            ClearValue::Depth(depth) | ClearValue::DepthStencil(depth, _) => depth,
            ClearValue::Color(_) => 0.0,
        })
    });
    let stencil_ops = ops.filter(|_| has_stencil && aspect != Aspect::Depth).map(|(begin, end)| {
        operations(&begin, &end, |value| match value {
            ClearValue::DepthStencil(_, stencil) => stencil,
            ClearValue::Depth(_) | ClearValue::Color(_) => 0,
        })
    });
    Ok(Some(wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops }))
}

fn operations<V>(
    begin: &AttachmentOps,
    end: &AttachmentOps,
    clear: impl Fn(ClearValue) -> V,
) -> wgpu::Operations<V> {
    wgpu::Operations {
        load: match begin.load {
            LoadAction::Clear(value) => wgpu::LoadOp::Clear(clear(value)),
            LoadAction::Load | LoadAction::Continue => wgpu::LoadOp::Load,
        },
        store: match end.store {
            StoreAction::Store | StoreAction::Continue => wgpu::StoreOp::Store,
            StoreAction::Discard => wgpu::StoreOp::Discard,
        },
    }
}

/// Returns the formats and the sample count of a pass's attachments.
pub(super) fn targets(plan: &Plan, pass: PassId) -> Targets {
    let mut targets = Targets { colors: Vec::new(), depth_stencil: None, samples: 1 };
    for access in plan.accesses(pass) {
        let ResourceDesc::Texture(desc) = plan.resource(access.resource).desc else { continue };
        match access.access {
            Access::Color(index) => {
                let format: Option<Format> = Some(desc.format);
                targets.colors.resize(targets.colors.len().max(index as usize + 1), None);
                targets.colors[index as usize] = format;
                targets.samples = desc.samples;
            }
            Access::Depth | Access::DepthRead => {
                targets.depth_stencil = Some(desc.format);
                targets.samples = desc.samples;
            }
            _ => {}
        }
    }
    targets
}

impl<'a> Recording<'a> {
    /// Returns the view of an attachment.
    fn view(&'a self, access: usize) -> Result<&'a wgpu::TextureView, Error> {
        let resource = self.plan.decl.accesses[access].resource;
        self.resolved.views[access].as_ref().ok_or_else(|| self.missing_import(resource))
    }
}
