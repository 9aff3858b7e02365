//! Following a plan.

use super::Executed;
use super::attachments::{color_attachment, depth_attachment};
use super::context::{Body, ComputeContext, EncoderContext, Frozen, RenderContext, Resources};
use super::copies::{self, Staging};
use super::timer::Timer;
use crate::compiled::Compiled;
use crate::declaration::PassKind;
use crate::error::Error;
use crate::frame::Frame;
use crate::handle::{PassId, ResourceId, SlotId};
use crate::plan::{AccessPlan, PassPlan, Plan};
use crate::pool::{Physical, Pool};

pub(super) fn record(
    compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    mut timer: Option<&mut Timer>,
) -> Result<Executed, Error> {
    let Compiled { plan, mut frame } = compiled;
    pool.begin_frame();
    let physical = materialise(&plan, &frame, pool, device)?;
    let staging = Staging::new(device, &plan, &frame.uploads);
    if let Some(timer) = timer.as_deref_mut() {
        timer.begin(device, &plan);
    }
    let mut label = String::new();
    for id in plan.live_passes() {
        label.clear();
        plan.write_pass_path(id, &mut label);
        let body = std::mem::replace(&mut frame.bodies[id.index()], Body::None);
        let frozen = Frozen { plan: &plan, frame: frame.id(), physical: &physical, device };
        let mut recorder = Recorder { frozen, pool, encoder, staging: &staging, timer: timer.as_deref_mut() };
        recorder.pass(id, &label, body).map_err(|error| name_pass(error, &plan, id))?;
    }
    if let Some(timer) = timer {
        timer.end(encoder);
    }
    let exported = plan.resources.iter().zip(&physical).enumerate().filter(|(_, (r, _))| r.exported);
    let exports = exported.filter_map(|(i, (_, p))| Some((ResourceId(i as u32), p.clone()?))).collect();
    Ok(Executed { frame: frame.id(), exports, plan })
}

/// Gives a body's own error the name of its pass.
fn name_pass(error: Error, plan: &Plan, id: PassId) -> Error {
    match error {
        Error::Body { pass, message } if pass.is_empty() => Error::Body { pass: plan.pass_path(id), message },
        error => error,
    }
}

/// Finds what stands behind each resource.
fn materialise(
    plan: &Plan,
    frame: &Frame<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
) -> Result<Vec<Option<Physical>>, Error> {
    let slots = plan
        .slots
        .iter()
        .map(|slot| pool.acquire(device, slot, &plan.resource(slot.tenants[0]).name))
        .collect::<Result<Vec<_>, _>>()?;
    let behind = |(index, slot): (usize, Option<SlotId>)| match slot {
        Some(slot) => Some(slots[slot.index()].clone()),
        None => frame.imports[index].clone(),
    };
    Ok(plan.resources.iter().map(|r| r.slot).enumerate().map(behind).collect())
}

struct Recorder<'a> {
    frozen: Frozen<'a>,
    pool: &'a mut Pool,
    encoder: &'a mut wgpu::CommandEncoder,
    staging: &'a Staging,
    timer: Option<&'a mut Timer>,
}

impl Recorder<'_> {
    fn pass(&mut self, id: PassId, label: &str, body: Body<'_>) -> Result<(), Error> {
        let started = self.timer.as_ref().map(|_| std::time::Instant::now());
        match self.frozen.plan.pass(id).kind {
            PassKind::Render => self.render(id, label, body)?,
            PassKind::Compute => self.compute(id, label, body)?,
            PassKind::Copy | PassKind::Encoder => self.encode(id, label, body)?,
        }
        if let (Some(timer), Some(started)) = (self.timer.as_deref_mut(), started) {
            timer.cpu(id, started.elapsed());
        }
        Ok(())
    }

    fn render(&mut self, id: PassId, label: &str, body: Body<'_>) -> Result<(), Error> {
        let pass = self.frozen.plan.pass(id);
        let views = self.attachment_views(pass)?;
        let colors: Vec<_> =
            views.iter().filter_map(|(access, view)| color_attachment(access, view)).collect();
        let depth = views.iter().find_map(|(access, view)| depth_attachment(access, view));
        let timestamps = self.timer.as_deref().and_then(|timer| timer.queries(id));
        let timestamp_writes = timestamps.map(|(query_set, begin)| wgpu::RenderPassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(begin + 1),
        });
        let pass = self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(label),
            color_attachments: &colors,
            depth_stencil_attachment: depth,
            timestamp_writes,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        if let Body::Render(body) = body {
            let resources = Resources { frozen: self.frozen, pool: self.pool, pass: id };
            body(&mut RenderContext { pass, resources })?;
        }
        Ok(())
    }

    fn compute(&mut self, id: PassId, label: &str, body: Body<'_>) -> Result<(), Error> {
        let timestamps = self.timer.as_deref().and_then(|timer| timer.queries(id));
        let timestamp_writes = timestamps.map(|(query_set, begin)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(begin + 1),
        });
        let pass = self
            .encoder
            .begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes });
        if let Body::Compute(body) = body {
            let resources = Resources { frozen: self.frozen, pool: self.pool, pass: id };
            body(&mut ComputeContext { pass, resources })?;
        }
        Ok(())
    }

    /// Copies and raw encoding, between two timestamps where the device can write them there.
    fn encode(&mut self, id: PassId, label: &str, body: Body<'_>) -> Result<(), Error> {
        if let Some((queries, begin)) = self.timer.as_deref().and_then(|timer| timer.encoder_queries(id)) {
            self.encoder.write_timestamp(queries, begin);
        }
        self.encoder.push_debug_group(label);
        for copy in &self.frozen.plan.pass(id).copies {
            copies::copy(self.frozen, self.staging, self.encoder, copy)?;
        }
        if let Body::Encoder(body) = body {
            let resources = Resources { frozen: self.frozen, pool: self.pool, pass: id };
            body(&mut EncoderContext { encoder: self.encoder, resources })?;
        }
        self.encoder.pop_debug_group();
        if let Some((queries, begin)) = self.timer.as_deref().and_then(|timer| timer.encoder_queries(id)) {
            self.encoder.write_timestamp(queries, begin + 1);
        }
        Ok(())
    }

    fn attachment_views(&mut self, pass: &PassPlan) -> Result<Vec<(AccessPlan, wgpu::TextureView)>, Error> {
        let attachments = pass.accesses.iter().filter(|a| a.access.is_attachment());
        let mut views = Vec::with_capacity(4);
        for access in attachments {
            let texture = self.frozen.texture(access.resource)?;
            views.push((*access, self.pool.view(texture, wgpu::TextureAspect::All)));
        }
        Ok(views)
    }
}
