//! Recording a render step: one wgpu render pass for one pass of the frame, or for several that were merged.

use super::attachments::{ColorAttachments, targets};
use super::shader_pass;
use crate::access::{Access, ClearValue, Contents};
use crate::context::{Bodies, Body, Recording, RenderContext, Resources};
use crate::declaration::ALL_OF_RESOURCE;
use crate::desc::Extent;
use crate::error::Error;
use crate::handle::PassId;
use crate::internal::{RegionClear, Targets};
use crate::plan::{AccessPlan, AttachmentOps, LoadAction};
use crate::subresource::{Aspect, Rect};

impl<'a> Recording<'a> {
    pub(super) fn render(
        &'a self,
        step: usize,
        passes: &[PassId],
        encoder: &mut wgpu::CommandEncoder,
        bodies: &mut Bodies<'_, '_>,
    ) -> Result<(), Error> {
        let (first, last) = (passes[0], passes[passes.len() - 1]);
        let mut color_attachments = ColorAttachments::new();
        self.add_colors(step, &mut color_attachments)?;
        let depth_stencil_attachment = self.depth(step)?;
        let timestamps = self.timer.and_then(|timer| timer.step_queries(first, last));
        let timestamp_writes = timestamps.map(|(query_set, begin, end)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(end),
        });
        let desc = wgpu::RenderPassDescriptor {
            label: Some(self.resolved.label(first)),
            color_attachments: &color_attachments,
            depth_stencil_attachment,
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        };
        let mut context = begin(encoder, &desc, Resources { recording: self, pass: first });
        for &id in passes {
            context.resources.pass = id;
            self.record_pass(id, passes, &mut context, bodies.next(id))?;
        }
        Ok(())
    }

    /// Records one of the passes that share a render pass.
    fn record_pass(
        &self,
        id: PassId,
        passes: &[PassId],
        context: &mut RenderContext<'_>,
        body: Option<&mut Body<'_>>,
    ) -> Result<(), Error> {
        let several = passes.len() > 1;
        if several {
            context.pass.push_debug_group(self.resolved.label(id));
        }
        let inside = self.timer.and_then(|timer| timer.inside_queries(id, several));
        if let Some((queries, begin)) = inside {
            context.pass.write_timestamp(queries, begin);
        }
        let counted = self.timer.and_then(|timer| timer.triangle_query(id));
        let drawn = self.clear_regions(id, context);
        self.reset_state(id, context, several && id != passes[0] || drawn);
        if let Some((queries, query)) = counted {
            context.pass.begin_pipeline_statistics_query(queries, query);
        }
        match body {
            Some(Body::Render(body)) => self.timed(id, || body(context))?,
            Some(Body::ShaderPass(index)) => self.timed(id, || shader_pass::draw(context, *index))?,
            _ => {}
        }
        if counted.is_some() {
            context.pass.end_pipeline_statistics_query();
        }
        if let Some((queries, begin)) = inside {
            context.pass.write_timestamp(queries, begin + 1);
        }
        if several {
            context.pass.pop_debug_group();
        }
        Ok(())
    }

    /// Draws the clears that load operations cannot do, and returns whether there were any.
    fn clear_regions(&self, id: PassId, context: &mut RenderContext<'_>) -> bool {
        if self.plan.decl.subresources.is_empty() && !self.pool.poison {
            return false;
        }
        // In poison mode the earlier pass may have cleared to the poison value instead, so its clear does not count.
        let again = |load| self.pool.poison && load == LoadAction::Continue;
        let drawn = |ops: &Option<AttachmentOps>| ops.is_some_and(|ops| ops.clear_drawn || again(ops.load));
        if !self.plan.ops[self.plan.decl.access_range(id)].iter().any(drawn) {
            return false;
        }
        let cleared = |access: &AccessPlan| drawn(&access.ops);
        let targets: Targets = targets(self.plan, id);
        let mut caches = self.pool.caches();
        // Attachments may have different parts, so each is cleared separately.
        for access in self.plan.accesses(id).filter(cleared) {
            let Some(Contents::Clear(value)) = access.contents else { continue };
            let mut colors = vec![None; targets.colors.len()];
            let (depth, stencil) = match (access.access, value) {
                (Access::Color(index), ClearValue::Color(rgba)) => {
                    colors[index as usize] = Some(rgba);
                    (None, None)
                }
                (_, ClearValue::Depth(depth)) => (Some(depth), Some(0)),
                (_, ClearValue::DepthStencil(depth, stencil)) => (Some(depth), Some(stencil)),
                _ => (None, None),
            };
            let aspect = access.subresource.aspect;
            let (depth, stencil) =
                (depth.filter(|_| aspect != Aspect::Stencil), stencil.filter(|_| aspect != Aspect::Depth));
            let rect = access.subresource.rect.unwrap_or_else(|| full_rect(self.attachment_size(&access)));
            let clear = RegionClear { colors: &colors, depth, stencil, rect };
            caches.clears.record(self.device, &mut context.pass, &targets, &clear);
        }
        true
    }

    /// Resets the pass to the state that a body may rely on; `dirty` says whether it may have been changed.
    fn reset_state(&self, id: PassId, context: &mut RenderContext<'_>, dirty: bool) {
        let decl = &self.plan.decl;
        let has_partial_accesses = !decl.subresources.is_empty()
            && decl.accesses(id).iter().any(|access| access.subresource != ALL_OF_RESOURCE);
        if !dirty && !has_partial_accesses {
            return;
        }
        let pass = &mut context.pass;
        let mut attachments = self.plan.accesses(id).filter(|a| a.access.is_attachment());
        let tile = attachments.clone().find_map(|access| access.subresource.rect);
        if !dirty && tile.is_none() {
            return;
        }
        let Some(first) = attachments.next() else { return };
        let rect = tile.unwrap_or_else(|| full_rect(self.attachment_size(&first)));
        pass.set_viewport(rect.x as f32, rect.y as f32, rect.width as f32, rect.height as f32, 0.0, 1.0);
        pass.set_scissor_rect(rect.x, rect.y, rect.width, rect.height);
        if dirty {
            pass.set_stencil_reference(0);
            pass.set_blend_constant(wgpu::Color::TRANSPARENT);
            for group in 0..self.max_bind_groups {
                pass.set_bind_group(group, None, &[]);
            }
        }
    }

    fn attachment_size(&self, access: &AccessPlan) -> Extent {
        match self.texture(access.resource) {
            Ok(texture) => {
                let mip = access.subresource.mips.map_or(0, |(first, _)| first);
                texture.size().mip_level_size(mip, texture.dimension())
            }
            Err(_) => Extent { width: 1, height: 1, depth_or_array_layers: 1 },
        }
    }
}

/// Begins a render pass. It is a separate function so that the pass, a kilobyte, is not copied into the context.
#[inline(never)]
fn begin<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    desc: &wgpu::RenderPassDescriptor<'_>,
    resources: Resources<'a>,
) -> RenderContext<'a> {
    RenderContext { pass: encoder.begin_render_pass(desc), resources }
}

fn full_rect(size: Extent) -> Rect {
    Rect::new(0, 0, size.width, size.height)
}
