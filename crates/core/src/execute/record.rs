//! Recording the steps of a plan.

use super::Executed;
use super::copies::{record_copies, stage_uploads};
use super::shader_pass;
use crate::compiled::Compiled;
use crate::context::{Bodies, Body, ComputeContext, EncoderContext, Recording, Resources, Uploads};
use crate::declaration::PassKind;
use crate::error::Error;
use crate::handle::{PassId, ResourceId};
use crate::pool::{Pool, ResolvedPlan};
use crate::read_back::ReadBack;
use crate::timer::Timer;
use std::ops::Range;
use web_time::Instant;

/// A frame whose physical objects are acquired and whose uploads are staged.
pub(super) struct Prepared {
    resolved: ResolvedPlan,
    uniforms: Option<wgpu::Buffer>,
    uploads: Uploads,
}

/// Is called after each pass of a step, once the step is recorded.
pub(super) type AfterPassHook<'h> =
    dyn FnMut(&Recording<'_>, PassId, &mut wgpu::CommandEncoder) -> Result<(), Error> + 'h;

pub(super) fn record(
    compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    timer: Option<&mut Timer>,
    after_pass: Option<&mut AfterPassHook<'_>>,
) -> Result<Executed, Error> {
    record_plan(compiled, pool, device, encoder, timer, after_pass)
        .map_err(|error| pool.classify_error(device, error))
}

fn record_plan(
    mut compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    mut timer: Option<&mut Timer>,
    after_pass: Option<&mut AfterPassHook<'_>>,
) -> Result<Executed, Error> {
    let prepared = prepare(&compiled, pool, device, encoder, None)?;
    if let Some(timer) = timer.as_deref_mut() {
        timer.begin(device, &compiled.plan);
    }
    let mut bodies = std::mem::take(&mut compiled.frame.work.bodies);
    let recording = prepared.recording(&compiled, pool, device, timer.as_deref());
    match after_pass {
        None => recording.steps(0..compiled.plan.steps.len(), encoder, Bodies::OfFrame(&mut bodies))?,
        Some(after_pass) => {
            for (index, step) in compiled.plan.steps().enumerate() {
                recording.steps(index..index + 1, encoder, Bodies::OfFrame(&mut bodies))?;
                step.passes.iter().try_for_each(|&pass| after_pass(&recording, pass, encoder))?;
            }
        }
    }
    let read_backs = recording.read_backs(&compiled.frame.work.read_backs, encoder)?;
    compiled.frame.work.bodies = bodies;
    if let Some(timer) = timer {
        timer.end(device, encoder)?;
    }
    Ok(prepared.finish(compiled, pool, read_backs))
}

/// Acquires the physical objects of the plan's resources and stages the uploads. `last` is the last encoder of the frame,
/// if that is not the first.
pub(super) fn prepare(
    compiled: &Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    last: Option<&wgpu::CommandEncoder>,
) -> Result<Prepared, Error> {
    let (plan, work) = (&compiled.plan, &compiled.frame.work);
    let frame = pool.begin_frame();
    let mut resolved = ResolvedPlan::acquire(plan, pool, device, frame)?;
    pool.enforce_budget();
    pool.histories.acquire((plan, &work.histories), &mut resolved.objects, device, encoder)?;
    resolved.bind_imports(&work.imports, pool);
    let (uniforms, uploads) = stage_uploads(compiled, pool, device, encoder, last)?;
    Ok(Prepared { resolved, uniforms, uploads })
}

impl Prepared {
    pub(super) fn recording<'a>(
        &'a self,
        compiled: &'a Compiled<'_>,
        pool: &'a Pool,
        device: &'a wgpu::Device,
        timer: Option<&'a Timer>,
    ) -> Recording<'a> {
        Recording {
            plan: &compiled.plan,
            frame: compiled.frame.id(),
            places: &compiled.frame.decl.places,
            resolved: &self.resolved,
            pool,
            device,
            uniforms: self.uniforms.as_ref(),
            uploads: &self.uploads,
            timer,
            shader_passes: &compiled.frame.work.shader_passes,
            max_bind_groups: device.limits().max_bind_groups,
        }
    }

    pub(super) fn finish(
        self,
        compiled: Compiled<'_>,
        pool: &mut Pool,
        read_backs: Vec<Option<ReadBack>>,
    ) -> Executed {
        let resources = compiled.plan.decl.resources.iter().zip(&self.resolved.objects).enumerate();
        let exported = resources.filter(|(_, (resource, _))| resource.exported.is_some());
        let exports = exported
            .filter_map(|(index, (_, object))| Some((ResourceId(index as u32), object.clone()?)))
            .collect();
        self.resolved.release(pool);
        pool.end_frame(&compiled.plan, &compiled.frame.work.histories);
        Executed {
            frame: compiled.frame.id(),
            exports,
            read_backs,
            values: None,
            watched: None,
            plan: compiled.plan.clone(),
        }
    }
}

impl<'a> Recording<'a> {
    /// Records some of the steps.
    pub(super) fn steps(
        &'a self,
        steps: Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
        mut bodies: Bodies<'_, '_>,
    ) -> Result<(), Error> {
        for step in steps {
            let (start, end) = self.plan.steps[step];
            let passes = &self.plan.order[start as usize..end as usize];
            if self.pool.poison {
                self.poison_first_uses(step, encoder);
            }
            match self.plan.decl.pass(passes[0]).kind {
                PassKind::Render => self.render(step, passes, encoder, &mut bodies)?,
                PassKind::Compute => self.compute(passes[0], encoder, bodies.next(passes[0]))?,
                PassKind::Copy | PassKind::Encoder => {
                    self.encode(passes[0], encoder, bodies.next(passes[0]))?
                }
            }
            if self.pool.poison {
                self.poison_discards(passes, encoder);
            }
        }
        Ok(())
    }

    /// Runs a body, adds the name of its pass to its error, and measures its time.
    pub(super) fn timed(&self, id: PassId, body: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
        let _span = tracing::debug_span!("pass", name = self.resolved.label(id)).entered();
        let started = self.timer.map(|timer| (timer, Instant::now()));
        let result = body();
        if let Some((timer, started)) = started {
            timer.cpu(id, started);
        }
        result.map_err(|error| match error {
            Error::Body { pass, message } if pass.path().is_empty() => {
                Error::Body { pass: self.pass_name(id), message }
            }
            error => error,
        })
    }

    fn compute(
        &'a self,
        id: PassId,
        encoder: &mut wgpu::CommandEncoder,
        body: Option<&mut Body<'_>>,
    ) -> Result<(), Error> {
        let timestamps = self.timer.and_then(|timer| timer.step_queries(id, id));
        let timestamp_writes = timestamps.map(|(query_set, begin, end)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(end),
        });
        let label = Some(self.resolved.label(id));
        let mut context = ComputeContext {
            pass: encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes }),
            resources: Resources { recording: self, pass: id },
        };
        match body {
            Some(Body::Compute(body)) => self.timed(id, || body(&mut context))?,
            Some(Body::ShaderPass(index)) => {
                self.timed(id, || shader_pass::dispatch(&mut context, *index))?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Records a copy or encoder pass, between two timestamps where the device supports them in encoders.
    fn encode(
        &'a self,
        id: PassId,
        encoder: &mut wgpu::CommandEncoder,
        body: Option<&mut Body<'_>>,
    ) -> Result<(), Error> {
        let queries = self.timer.and_then(|timer| timer.encoder_queries(id));
        if let Some((queries, begin)) = queries {
            encoder.write_timestamp(queries, begin);
        }
        encoder.push_debug_group(self.resolved.label(id));
        self.timed(id, || {
            record_copies(self, id, encoder)?;
            if let Some(Body::Encoder(body)) = body {
                let resources = Resources { recording: self, pass: id };
                body(&mut EncoderContext { encoder, resources })?;
            }
            Ok(())
        })?;
        encoder.pop_debug_group();
        if let Some((queries, begin)) = queries {
            encoder.write_timestamp(queries, begin + 1);
        }
        Ok(())
    }
}
