//! Choosing an adapter and opening a device, where a thread can wait for it.

use super::Gpu;
use crate::error::Error;
use crate::options::adapter::AdapterChoice;

/// The advice if no adapter is found.
const INSTALL: &str = "install a Vulkan driver, for example `sudo apt-get install mesa-vulkan-drivers`";

impl Gpu {
    /// Opens a device without a window.
    ///
    /// # Errors
    /// [`Error::NoAdapter`] with the available adapters and what to install; [`Error::NoDevice`] if the driver does not create a
    /// device.
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
    pub fn noop() -> Result<Self, Error> {
        Self::from_adapter(&Self::noop_adapter()?)
    }

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

    /// Opens a device like [`request`](Self::request), and waits for it.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if the driver does not create a device.
    pub fn from_adapter(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        pollster::block_on(Self::request(adapter))
    }
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
