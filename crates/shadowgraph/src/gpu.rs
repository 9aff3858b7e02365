//! Devices, and their errors.

#[cfg(not(target_arch = "wasm32"))]
mod native;

use shadowgraph_core::{device_is_lost, with_error_scopes};

use crate::error::Error;

/// Features that are used if the adapter has them.
const OPTIONAL_FEATURES: wgpu::Features = wgpu::Features::DEPTH_CLIP_CONTROL
    .union(wgpu::Features::INDIRECT_FIRST_INSTANCE)
    .union(wgpu::Features::TEXTURE_COMPRESSION_ASTC)
    .union(wgpu::Features::TEXTURE_COMPRESSION_BC)
    .union(wgpu::Features::TEXTURE_COMPRESSION_ETC2)
    .union(wgpu::Features::TIMESTAMP_QUERY)
    .union(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS)
    .union(wgpu::Features::PIPELINE_STATISTICS_QUERY);

/// Returns the features to use on an adapter. Timestamps inside a render pass measure merged passes separately, but software
/// adapters and tile-based GPUs do most of the work at the end of the render pass, after all of them.
fn optional_features(adapter: &wgpu::AdapterInfo) -> wgpu::Features {
    match adapter.device_type {
        wgpu::DeviceType::DiscreteGpu => OPTIONAL_FEATURES | wgpu::Features::TIMESTAMP_QUERY_INSIDE_PASSES,
        _ => OPTIONAL_FEATURES,
    }
}

/// Returns small blocks of memory for software adapters: some of them clear each block when it is allocated.
fn memory_hints(adapter: &wgpu::AdapterInfo) -> wgpu::MemoryHints {
    match adapter.device_type {
        wgpu::DeviceType::Cpu => wgpu::MemoryHints::MemoryUsage,
        _ => wgpu::MemoryHints::Performance,
    }
}

/// A device with its queue and adapter.
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// The queue.
    pub queue: wgpu::Queue,
    /// Information about the adapter.
    pub adapter: wgpu::AdapterInfo,
}

impl Gpu {
    /// Opens a device of an adapter, with the optional features that it has and its limits of sizes, without blocking: in browsers the
    /// only way.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if the driver does not create a device.
    pub async fn request(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        let info = adapter.get_info();
        let (has, default) = (adapter.limits(), wgpu::Limits::default());
        let limits = wgpu::Limits {
            max_buffer_size: has.max_buffer_size,
            max_storage_buffer_binding_size: has.max_storage_buffer_binding_size,
            ..default.using_resolution(has)
        };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("shadowgraph"),
            required_features: adapter.features() & optional_features(&info),
            required_limits: limits,
            memory_hints: memory_hints(&info),
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|error| Error::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        Ok(Self { device, queue, adapter: info })
    }
}

impl Gpu {
    /// Runs `work` in error scopes and returns wgpu's errors, which would end the program by default.
    ///
    /// # Errors
    /// Those of `work`, and [`Error::Gpu`] with wgpu's message. On a lost device every error is
    /// [`DeviceLost`](shadowgraph_core::Error::DeviceLost).
    pub fn checked<T, E: From<Error>>(&self, work: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        use wgpu::ErrorFilter::{Internal, OutOfMemory, Validation};
        let filters = [Internal, OutOfMemory, Validation];
        let (done, error) = with_error_scopes(&self.device, &filters, work);
        match (error, done) {
            (None, Ok(done)) => Ok(done),
            _ if device_is_lost(&self.device) => Err(Error::from(shadowgraph_core::Error::DeviceLost).into()),
            (Some(error), _) => Err(Error::Gpu(one_line(&error.to_string())).into()),
            (None, Err(error)) => Err(error),
        }
    }

    /// Submits what `record` records.
    pub(crate) fn submit<T>(
        &self,
        record: impl FnOnce(&mut wgpu::CommandEncoder) -> Result<T, Error>,
    ) -> Result<T, Error> {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let recorded = record(&mut encoder)?;
        self.queue.submit([encoder.finish()]);
        Ok(recorded)
    }
}

/// Joins the lines of wgpu's message.
pub(crate) fn one_line(message: &str) -> String {
    let lines: Vec<_> = message.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    lines.join("; ")
}
