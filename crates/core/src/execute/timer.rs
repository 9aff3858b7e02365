//! How long each pass took.

use crate::error::Error;
use crate::handle::PassId;
use crate::plan::Plan;
use serde::Serialize;
use std::time::Duration;

/// Measures every pass of one frame: CPU time of recording, and GPU time where the device has timestamps.
///
/// Pass it to [`Compiled::execute_timed`](crate::Compiled::execute_timed), submit, then [`read`](Self::read).
#[derive(Default)]
pub struct Timer {
    passes: Vec<PassId>,
    cpu: Vec<Duration>,
    gpu: Option<Queries>,
}

struct Queries {
    set: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
    /// Copies and raw encoding can be measured.
    inside_encoders: bool,
}

/// The time of one pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassTime {
    /// The pass, with its nodes before its name.
    pub pass: String,
    /// The node it belongs to; empty for none.
    pub node: String,
    /// Milliseconds of recording on the CPU.
    pub cpu_ms: f64,
    /// Milliseconds on the GPU; `None` where the device cannot tell.
    pub gpu_ms: Option<f64>,
}

impl Timer {
    /// Creates a timer for one frame.
    pub fn new() -> Self {
        Self::default()
    }

    pub(super) fn begin(&mut self, device: &wgpu::Device, plan: &Plan) {
        self.passes = plan.live_passes().collect();
        self.cpu = vec![Duration::ZERO; self.passes.len()];
        let count = self.passes.len() as u32 * 2;
        let able = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        self.gpu =
            (able && count > 0 && count <= wgpu::QUERY_SET_MAX_QUERIES).then(|| Queries::new(device, count));
    }

    pub(super) fn end(&mut self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(gpu) = &self.gpu {
            let count = self.passes.len() as u32 * 2;
            encoder.resolve_query_set(&gpu.set, 0..count, &gpu.resolved, 0);
            encoder.copy_buffer_to_buffer(&gpu.resolved, 0, &gpu.readable, 0, gpu.readable.size());
        }
    }

    pub(super) fn cpu(&mut self, pass: PassId, time: Duration) {
        if let Some(index) = self.index(pass) {
            self.cpu[index] = time;
        }
    }

    /// The query set, and the first of the pass's two queries.
    pub(super) fn queries(&self, pass: PassId) -> Option<(&wgpu::QuerySet, u32)> {
        let gpu = self.gpu.as_ref()?;
        Some((&gpu.set, self.index(pass)? as u32 * 2))
    }

    pub(super) fn encoder_queries(&self, pass: PassId) -> Option<(&wgpu::QuerySet, u32)> {
        self.gpu.as_ref().filter(|gpu| gpu.inside_encoders)?;
        self.queries(pass)
    }

    fn index(&self, pass: PassId) -> Option<usize> {
        self.passes.iter().position(|&p| p == pass)
    }

    /// Waits for the submitted frame and returns the times, in order of recording.
    ///
    /// # Errors
    /// When the device is lost or the times cannot be mapped.
    pub fn read(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        plan: &Plan,
    ) -> Result<Vec<PassTime>, Error> {
        let ticks = self.gpu.as_ref().map(|gpu| gpu.read(device)).transpose()?;
        let period = f64::from(queue.get_timestamp_period());
        let gpu_ms = |index: usize| {
            let ticks = ticks.as_ref()?;
            let (begin, end) = (*ticks.get(index * 2)?, *ticks.get(index * 2 + 1)?);
            (end >= begin && begin != 0).then(|| (end - begin) as f64 * period * 1e-6)
        };
        let times = self.passes.iter().zip(&self.cpu).enumerate().map(|(index, (&pass, cpu))| PassTime {
            pass: plan.pass_path(pass),
            node: plan.pass(pass).node.map(|node| plan.node_path(node)).unwrap_or_default(),
            cpu_ms: cpu.as_secs_f64() * 1e3,
            gpu_ms: gpu_ms(index),
        });
        Ok(times.collect())
    }
}

impl Queries {
    fn new(device: &wgpu::Device, count: u32) -> Self {
        let buffer = |label, usage| {
            let size = u64::from(count) * 8;
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size,
                usage,
                mapped_at_creation: false,
            })
        };
        use wgpu::BufferUsages as Usage;
        Self {
            set: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count,
            }),
            resolved: buffer("pass times, resolved", Usage::QUERY_RESOLVE | Usage::COPY_SRC),
            readable: buffer("pass times, readable", Usage::MAP_READ | Usage::COPY_DST),
            inside_encoders: device.features().contains(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS),
        }
    }

    fn read(&self, device: &wgpu::Device) -> Result<Vec<u64>, Error> {
        let failed = |error: &dyn std::fmt::Display| Error::Body {
            pass: "timer".into(),
            message: format!("the times cannot be read: {error}"),
        };
        self.readable.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        let view = self.readable.get_mapped_range(..).map_err(|error| failed(&error))?;
        let word = |bytes: &[u8]| u64::from_le_bytes([0, 1, 2, 3, 4, 5, 6, 7].map(|i| bytes[i]));
        Ok(view.chunks_exact(8).map(word).collect())
    }
}
