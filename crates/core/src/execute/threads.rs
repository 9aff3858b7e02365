//! Recording on several threads, one of which is the caller's.

use super::Executed;
use super::record::prepare;
use crate::compiled::Compiled;
use crate::context::{Bodies, Body, Recording};
use crate::error::Error;
use crate::handle::PassId;
use crate::pool::Pool;
use std::ops::Range;
use std::thread::ScopedJoinHandle;

/// A range of steps with the bodies of their passes, in order.
struct StepRange<'f> {
    steps: Range<usize>,
    bodies: Vec<Body<'f>>,
}

pub(super) fn record(
    mut compiled: Compiled<'_>,
    pool: &mut Pool,
    device: &wgpu::Device,
    threads: usize,
) -> Result<(Executed, Vec<wgpu::CommandBuffer>), Error> {
    // Threads of browsers need another build of the standard library.
    let threads = if cfg!(target_arch = "wasm32") { 1 } else { threads };
    let label = Some("frame");
    let encoder = || device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
    let mut bodies = std::mem::take(&mut compiled.frame.work.bodies);
    let ranges = split_steps(&compiled, &mut bodies, threads);
    compiled.frame.work.bodies = bodies;
    let (mut first, others) = (encoder(), (1..ranges.len()).map(|_| encoder()).collect::<Vec<_>>());
    let prepared = prepare(&compiled, pool, device, &mut first, others.last())?;
    let recording = prepared.recording(&compiled, pool, device, None);
    let results: Vec<_> = std::thread::scope(|scope| {
        let mut ranges = ranges.into_iter();
        let first_range = ranges.next();
        let recording = &recording;
        let spawn = |(range, encoder)| scope.spawn(move || record_range(recording, range, encoder));
        let workers: Vec<_> = ranges.zip(others).map(spawn).collect();
        let own = first_range.map(|range| record_range(recording, range, first));
        // A body's panic resumes on the caller's thread.
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

/// Splits the steps into ranges with similar numbers of passes.
fn split_steps<'f>(compiled: &Compiled<'_>, bodies: &mut [Body<'f>], threads: usize) -> Vec<StepRange<'f>> {
    let plan = &compiled.plan;
    let wanted = plan.order.len().div_ceil(threads.max(1)).max(1);
    let mut ranges: Vec<StepRange<'f>> = vec![StepRange { steps: 0..0, bodies: Vec::new() }];
    for (index, &(start, end)) in plan.steps.iter().enumerate() {
        if ranges.last().is_some_and(|range| range.bodies.len() >= wanted) {
            ranges.push(StepRange { steps: index..index, bodies: Vec::new() });
        }
        if let Some(range) = ranges.last_mut() {
            range.steps.end = index + 1;
            let passes = &plan.order[start as usize..end as usize];
            let take = |pass: &PassId| std::mem::replace(&mut bodies[pass.index()], Body::None);
            range.bodies.extend(passes.iter().map(take));
        }
    }
    ranges
}

fn record_range(
    recording: &Recording<'_>,
    mut range: StepRange<'_>,
    mut encoder: wgpu::CommandEncoder,
) -> Result<wgpu::CommandBuffer, Error> {
    recording.steps(range.steps, &mut encoder, Bodies::InOrder(range.bodies.iter_mut()))?;
    Ok(encoder.finish())
}
