//! The attachments of a plan, as wgpu takes them.

use crate::access::Access;
use crate::context::Recording;
use crate::desc::{Format, ResourceDesc};
use crate::device::MAX_COLOR_ATTACHMENTS;
use crate::error::Error;
use crate::handle::PassId;
use crate::internal::Targets;
use crate::plan::Plan;
use crate::pool::DepthAttachment;
use arrayvec::ArrayVec;

pub(super) type ColorAttachments<'v> =
    ArrayVec<Option<wgpu::RenderPassColorAttachment<'v>>, MAX_COLOR_ATTACHMENTS>;

impl<'a> Recording<'a> {
    /// Adds the colour attachments of a step.
    pub(super) fn add_colors(&'a self, step: usize, colors: &mut ColorAttachments<'a>) -> Result<(), Error> {
        for color in self.resolved.attachments.colors(step) {
            colors.push(match color {
                None => None,
                Some(color) => Some(wgpu::RenderPassColorAttachment {
                    view: self.view(color.access)?,
                    depth_slice: color.depth_slice,
                    resolve_target: color.resolve.map(|access| self.view(access)).transpose()?,
                    ops: color.ops,
                }),
            });
        }
        Ok(())
    }

    /// Returns the depth attachment of a step.
    pub(super) fn depth(
        &'a self,
        step: usize,
    ) -> Result<Option<wgpu::RenderPassDepthStencilAttachment<'a>>, Error> {
        let Some(depth) = self.resolved.attachments.depth(step) else { return Ok(None) };
        let &DepthAttachment { access, depth_ops, stencil_ops } = depth;
        Ok(Some(wgpu::RenderPassDepthStencilAttachment { view: self.view(access)?, depth_ops, stencil_ops }))
    }

    /// Returns the view of an attachment.
    fn view(&'a self, access: usize) -> Result<&'a wgpu::TextureView, Error> {
        let resource = self.plan.decl.accesses[access].resource;
        self.resolved.views[access].as_ref().ok_or_else(|| self.missing_import(resource))
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
