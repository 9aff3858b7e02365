//! Choosing an adapter and opening a device.

use shadowgraph_core::{device_is_lost, with_error_scopes};

use crate::error::Error;
use crate::options::adapter::AdapterChoice;

/// The advice if no adapter is found.
const INSTALL: &str = "install a Vulkan driver, for example `sudo apt-get install mesa-vulkan-drivers`";

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
    /// Opens a device without a window.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] with the available adapters and what to install; [`Error::NoDevice`] if the driver does not create a
    /// device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn open(choice: &AdapterChoice) -> Result<Self, Error> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::PRIMARY,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        Self::from_adapter(&choose(adapters, choice)?)
    }

    /// Opens a device that can draw into a window.
    ///
    /// # Errors
    /// As [`open`](Self::open), for the adapters that can.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn for_surface(
        instance: &wgpu::Instance,
        surface: &wgpu::Surface<'_>,
        choice: &AdapterChoice,
    ) -> Result<(Self, wgpu::Adapter), Error> {
        let mut adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::PRIMARY));
        adapters.retain(|adapter| adapter.is_surface_supported(surface));
        let adapter = choose(adapters, choice)?;
        Ok((Self::from_adapter(&adapter)?, adapter))
    }

    /// Opens wgpu's noop device, which validates everything and draws nothing. It is used for plans without a GPU.
    ///
    /// # Errors
    /// None in practice: the noop adapter is always available.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn noop() -> Result<Self, Error> {
        Self::from_adapter(&Self::noop_adapter()?)
    }

    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn noop_adapter() -> Result<wgpu::Adapter, Error> {
        let noop = wgpu::NoopBackendOptions { enable: true, ..Default::default() };
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::NOOP,
            backend_options: wgpu::BackendOptions { noop, ..Default::default() },
            // The pass in which wgpu checks the arguments of indirect draws does not accept this device's alignments.
            flags: wgpu::InstanceFlags::default() - wgpu::InstanceFlags::VALIDATION_INDIRECT_CALL,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::NOOP));
        choose(adapters, &AdapterChoice::Auto)
    }

    /// Opens a device of an adapter, with the optional features that it has and its limits of sizes.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if the driver does not create a device.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn from_adapter(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        pollster::block_on(Self::request(adapter))
    }

    /// Opens a device like `from_adapter`, without blocking: in browsers the only way.
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

/// Returns the best adapter that matches the choice.
fn choose(adapters: Vec<wgpu::Adapter>, choice: &AdapterChoice) -> Result<wgpu::Adapter, Error> {
    let names: Vec<_> = adapters.iter().map(|adapter| adapter.get_info().name).collect();
    let matches = |info: &wgpu::AdapterInfo| match choice {
        AdapterChoice::Auto => true,
        AdapterChoice::Cpu => info.device_type == wgpu::DeviceType::Cpu,
        AdapterChoice::Name(_) => choice.matches_name(&info.name),
    };
    let rank = |adapter: &wgpu::Adapter| match adapter.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    };
    let found = adapters.into_iter().filter(|adapter| matches(&adapter.get_info())).min_by_key(rank);
    found.ok_or_else(|| {
        let wanted = match choice {
            AdapterChoice::Auto => "any",
            AdapterChoice::Cpu => "a software adapter",
            AdapterChoice::Name(name) => name,
        };
        let reason = match names.as_slice() {
            [] => INSTALL.into(),
            names if matches!(choice, AdapterChoice::Name(_)) => format!("found: {}", names.join(", ")),
            names => format!("found: {}; {INSTALL}", names.join(", ")),
        };
        Error::NoAdapter { wanted: wanted.into(), reason }
    })
}
