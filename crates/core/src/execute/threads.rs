//! Recording on several threads, of which the caller's is one.

use super::Executed;
use super::context::Body;
use super::record::{Recording, prepare};
use crate::compiled::Compiled;
use crate::error::Error;
use crate::handle::PassId;
use crate::pool::Pool;
use std::ops::Range;
use std::thread::ScopedJoinHandle;

/// Bodies of some steps, in order.
struct Share<'f> {
    steps: Range<usize>,
    bodies: Vec<Body<'f>>,
}

pub(super) fn record(
    mut compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    threads: usize,
) -> Result<(Executed, Vec<wgpu::CommandBuffer>), Error> {
    let label = Some("frame");
    let encoder = || device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
    let mut bodies = std::mem::take(&mut compiled.frame.work.bodies);
    let shares = share(&compiled, &mut bodies, threads);
    compiled.frame.work.bodies = bodies;
    let (mut first, others) = (encoder(), (1..shares.len()).map(|_| encoder()).collect::<Vec<_>>());
    let prepared = prepare(&compiled, pool, device, &mut first, others.last())?;
    let recording = prepared.recording(&compiled, pool, device, None);
    let results: Vec<_> = std::thread::scope(|scope| {
        let mut shares = shares.into_iter();
        let own = shares.next();
        let recording = &recording;
        let spawn = |(share, encoder)| scope.spawn(move || one(recording, share, encoder));
        let workers: Vec<_> = shares.zip(others).map(spawn).collect();
        let own = own.map(|share| one(recording, share, first));
        // A body's panic goes on in the thread that asked for the frame.
        let join = |worker: ScopedJoinHandle<'_, _>| {
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        own.into_iter().chain(workers.into_iter().map(join)).collect()
    });
    let mut buffers = results.into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut read_backs = Vec::new();
    if !compiled.frame.work.read_backs.is_empty() {
        let mut last = encoder();
        read_backs = recording.read_backs(&compiled.frame.work.read_backs, &mut last)?;
        buffers.push(last.finish());
    }
    Ok((prepared.finish(compiled, pool, read_backs), buffers))
}

/// Divides the steps into runs of about as many passes.
fn share<'f>(compiled: &Compiled<'_>, bodies: &mut [Body<'f>], threads: usize) -> Vec<Share<'f>> {
    let plan = &compiled.plan;
    let wanted = plan.order.len().div_ceil(threads.max(1)).max(1);
    let mut shares: Vec<Share<'f>> = vec![Share { steps: 0..0, bodies: Vec::new() }];
    for (index, &(start, end)) in plan.steps.iter().enumerate() {
        if shares.last().is_some_and(|share| share.bodies.len() >= wanted) {
            shares.push(Share { steps: index..index, bodies: Vec::new() });
        }
        if let Some(share) = shares.last_mut() {
            share.steps.end = index + 1;
            let passes = &plan.order[start as usize..end as usize];
            let take = |pass: &PassId| std::mem::replace(&mut bodies[pass.index()], Body::None);
            share.bodies.extend(passes.iter().map(take));
        }
    }
    shares
}

fn one(
    recording: &Recording<'_>,
    share: Share<'_>,
    mut encoder: wgpu::CommandEncoder,
) -> Result<wgpu::CommandBuffer, Error> {
    let mut bodies = share.bodies.into_iter();
    recording.steps(share.steps, &mut encoder, |_| bodies.next().unwrap_or(Body::None))?;
    Ok(encoder.finish())
}
