//! Following a plan.

use super::context::{Body, ComputeContext, EncoderContext, Resources};
use super::copies::{self, Uploads};
use super::realise::Realised;
use super::timer::Timer;
use super::{Executed, ReadBack};
use crate::compiled::Compiled;
use crate::declaration::PassKind;
use crate::error::Error;
use crate::handle::{PassId, ResourceId};
use crate::plan::Plan;
use crate::pool::{Physical, Pool};
use crate::shader_pass::{self, ShaderPasses};
use std::ops::Range;
use std::time::Instant;

/// What stays the same for all passes of a frame.
pub(crate) struct Recording<'a> {
    pub(super) plan: &'a Plan,
    pub(super) frame: u64,
    pub(super) realised: &'a Realised,
    pub(super) pool: &'a Pool,
    pub(super) device: &'a wgpu::Device,
    pub(super) uniforms: Option<&'a wgpu::Buffer>,
    pub(super) uploads: &'a Uploads,
    pub(super) timer: Option<&'a Timer>,
    pub(super) calls: &'a ShaderPasses,
    /// Bind group slots that the device has.
    pub(super) groups: u32,
}

/// A frame whose objects are there and whose bytes are on their way.
pub(super) struct Prepared {
    pub(super) realised: Realised,
    pub(super) uniforms: Option<wgpu::Buffer>,
    pub(super) uploads: Uploads,
}

/// What is done behind each pass of a step, once the step is recorded.
pub(super) type Watch<'w> =
    dyn FnMut(&Recording<'_>, PassId, &mut wgpu::CommandEncoder) -> Result<(), Error> + 'w;

pub(super) fn record(
    compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    timer: Option<&mut Timer>,
    watch: Option<&mut Watch<'_>>,
) -> Result<Executed, Error> {
    follow(compiled, pool, device, encoder, timer, watch).map_err(|error| pool.explain(device, error))
}

fn follow(
    mut compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    mut timer: Option<&mut Timer>,
    watch: Option<&mut Watch<'_>>,
) -> Result<Executed, Error> {
    let prepared = prepare(&compiled, pool, device, encoder, None)?;
    if let Some(timer) = timer.as_deref_mut() {
        timer.begin(device, &compiled.plan);
    }
    let mut bodies = std::mem::take(&mut compiled.frame.work.bodies);
    let recording = prepared.recording(&compiled, pool, device, timer.as_deref());
    let mut take = |pass: PassId| std::mem::replace(&mut bodies[pass.index()], Body::None);
    match watch {
        None => recording.steps(0..compiled.plan.steps.len(), encoder, take)?,
        Some(watch) => {
            for (index, step) in compiled.plan.steps().enumerate() {
                recording.steps(index..index + 1, encoder, &mut take)?;
                step.passes.iter().try_for_each(|&pass| watch(&recording, pass, encoder))?;
            }
        }
    }
    let read_backs = recording.read_backs(&compiled.frame.work.read_backs, encoder)?;
    compiled.frame.work.bodies = bodies;
    if let Some(timer) = timer {
        timer.end(encoder);
    }
    Ok(prepared.finish(compiled, pool, read_backs))
}

/// Finds what stands behind the plan's resources, and records the uploads' way to the GPU. `last` is the last encoder
/// of the frame, where that is not the first.
pub(super) fn prepare(
    compiled: &Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    encoder: &mut wgpu::CommandEncoder,
    last: Option<&wgpu::CommandEncoder>,
) -> Result<Prepared, Error> {
    let frame = pool.begin_frame();
    let mut realised = Realised::take(&compiled.plan, pool, device, frame)?;
    pool.keep_budget();
    pool.histories.arrive(compiled, &mut realised.objects, device, encoder)?;
    realised.arrive(&compiled.frame.work, pool);
    let (uniforms, uploads) = copies::stage(compiled, pool, device, encoder, last)?;
    Ok(Prepared { realised, uniforms, uploads })
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
            realised: &self.realised,
            pool,
            device,
            uniforms: self.uniforms.as_ref(),
            uploads: &self.uploads,
            timer,
            calls: &compiled.frame.work.calls,
            groups: device.limits().max_bind_groups,
        }
    }

    pub(super) fn finish(
        self,
        compiled: Compiled<'_>,
        pool: &mut Pool,
        read_backs: Vec<Option<ReadBack>>,
    ) -> Executed {
        let resources = compiled.plan.decl.resources.iter().zip(&self.realised.objects).enumerate();
        let exported = resources.filter(|(_, (resource, _))| resource.exported.is_some());
        let exports =
            exported.filter_map(|(index, (_, own))| Some((ResourceId(index as u32), own.clone()?))).collect();
        self.realised.leave(pool);
        pool.end_frame(&compiled);
        Executed { frame: compiled.frame.id(), exports, read_backs, plan: compiled.plan.clone() }
    }
}

impl<'a> Recording<'a> {
    pub(super) fn texture(&self, id: ResourceId) -> Result<&'a wgpu::Texture, Error> {
        match &self.realised.objects[id.index()] {
            Some(Physical::Texture(texture)) => Ok(texture),
            _ => Err(self.absent(id)),
        }
    }

    pub(super) fn buffer(&self, id: ResourceId) -> Result<&'a wgpu::Buffer, Error> {
        match &self.realised.objects[id.index()] {
            Some(Physical::Buffer(buffer)) => Ok(buffer),
            _ => Err(self.absent(id)),
        }
    }

    /// Only an import that was declared without an object has nothing behind it.
    pub(super) fn absent(&self, id: ResourceId) -> Error {
        Error::NoImport { resource: self.plan.decl.resource_path(id) }
    }

    /// Records some of the steps; `take` gives the body of each pass, asked for in order.
    pub(super) fn steps<'f>(
        &'a self,
        steps: Range<usize>,
        encoder: &mut wgpu::CommandEncoder,
        mut take: impl FnMut(PassId) -> Body<'f>,
    ) -> Result<(), Error> {
        for step in steps {
            let (start, end) = self.plan.steps[step];
            let passes = &self.plan.order[start as usize..end as usize];
            if self.pool.poison {
                self.poison_arrivals(step, encoder);
            }
            match self.plan.decl.pass(passes[0]).kind {
                PassKind::Render => self.render(passes, encoder, &mut take)?,
                PassKind::Compute => self.compute(passes[0], encoder, take(passes[0]))?,
                PassKind::Copy | PassKind::Encoder => self.encode(passes[0], encoder, take(passes[0]))?,
            }
            if self.pool.poison {
                self.poison_discards(passes, encoder);
            }
        }
        Ok(())
    }

    /// Runs a body, gives its own error the name of its pass, and notes how long it took.
    pub(super) fn timed(&self, id: PassId, body: impl FnOnce() -> Result<(), Error>) -> Result<(), Error> {
        let _span = tracing::debug_span!("pass", name = self.realised.label(id)).entered();
        let started = self.timer.map(|timer| (timer, Instant::now()));
        let result = body();
        if let Some((timer, started)) = started {
            timer.cpu(id, started);
        }
        result.map_err(|error| match error {
            Error::Body { pass, message } if pass.is_empty() => {
                Error::Body { pass: self.plan.pass_path(id), message }
            }
            error => error,
        })
    }

    fn compute(
        &'a self,
        id: PassId,
        encoder: &mut wgpu::CommandEncoder,
        body: Body<'_>,
    ) -> Result<(), Error> {
        let timestamps = self.timer.and_then(|timer| timer.step_queries(id, id));
        let timestamp_writes = timestamps.map(|(query_set, begin, end)| wgpu::ComputePassTimestampWrites {
            query_set,
            beginning_of_pass_write_index: Some(begin),
            end_of_pass_write_index: Some(end),
        });
        let label = Some(self.realised.label(id));
        let pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label, timestamp_writes });
        let resources = Resources { recording: self, pass: id };
        let mut context = ComputeContext { pass, resources };
        match body {
            Body::Compute(body) => self.timed(id, || body(&mut context))?,
            Body::ShaderPass(call) => self.timed(id, || shader_pass::dispatch(&mut context, call))?,
            Body::None | Body::Render(_) | Body::Encoder(_) => {}
        }
        Ok(())
    }

    /// Copies and raw encoding, between two timestamps where the device can write them there.
    fn encode(&'a self, id: PassId, encoder: &mut wgpu::CommandEncoder, body: Body<'_>) -> Result<(), Error> {
        let queries = self.timer.and_then(|timer| timer.encoder_queries(id));
        if let Some((queries, begin)) = queries {
            encoder.write_timestamp(queries, begin);
        }
        encoder.push_debug_group(self.realised.label(id));
        self.timed(id, || {
            copies::copies(self, id, encoder)?;
            if let Body::Encoder(body) = body {
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
