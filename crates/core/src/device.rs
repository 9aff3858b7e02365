//! Detection of out-of-memory errors and lost devices.

use crate::error::Error;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Maximum number of colour attachments of a render pass on any device; `internal.wgsl` has the same number.
pub(crate) const MAX_COLOR_ATTACHMENTS: usize = 8;

/// Returns whether a device is lost: destroyed, removed, or reset by its driver. wgpu reports it only to the callback of
/// `Device::set_device_lost_callback`, and as late as in `Device::poll`; this function checks now, at about the cost of creating a
/// small buffer. A lost device cannot be restored: create another one, and recreate everything on it, including the
/// [`Graph`](crate::Graph).
///
/// ```
/// use shadowgraph_core::{device_is_lost, wgpu};
/// let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// assert!(!device_is_lost(&device));
/// device.destroy();
/// assert!(device_is_lost(&device));
/// ```
///
/// In browsers it returns `false`: there only the callback reports it.
pub fn device_is_lost(device: &wgpu::Device) -> bool {
    if cfg!(target_arch = "wasm32") {
        return false;
    }
    // A lost device returns a buffer without an error, but every use of it fails.
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("is the device lost?"),
        size: wgpu::COPY_BUFFER_ALIGNMENT,
        usage: wgpu::BufferUsages::MAP_WRITE,
        mapped_at_creation: false,
    });
    buffer.map_async(wgpu::MapMode::Write, .., drop);
    poll_once(scope.pop()).is_some()
}

/// Creates a texture or buffer of `bytes` bytes, or returns why it cannot. `name` is for the error.
pub(crate) fn create_checked<T>(
    device: &wgpu::Device,
    name: &str,
    bytes: u64,
    create: impl FnOnce(&wgpu::Device) -> T,
) -> Result<T, Error> {
    let (created, error) = with_error_scopes(device, &[wgpu::ErrorFilter::OutOfMemory], || create(device));
    if error.is_some() {
        return Err(Error::OutOfMemory { resource: name.into(), bytes });
    }
    if device_is_lost(device) { Err(Error::DeviceLost) } else { Ok(created) }
}

/// Runs `work` in error scopes, the last of which is the innermost, and returns the first error of wgpu too. Without a scope
/// it would go to the handler of [`Device::on_uncaptured_error`](wgpu::Device::on_uncaptured_error). In browsers, where
/// errors arrive later, it goes there.
///
/// ```
/// use shadowgraph_core::{with_error_scopes, wgpu};
/// let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// let (_sampler, error) = with_error_scopes(&device, &[wgpu::ErrorFilter::Validation], || {
///     device.create_sampler(&wgpu::SamplerDescriptor { anisotropy_clamp: 0, ..Default::default() })
/// });
/// assert!(error.is_some());
/// ```
pub fn with_error_scopes<T>(
    device: &wgpu::Device,
    filters: &[wgpu::ErrorFilter],
    work: impl FnOnce() -> T,
) -> (T, Option<wgpu::Error>) {
    let Some((&filter, inner)) = filters.split_first().filter(|_| cfg!(not(target_arch = "wasm32"))) else {
        return (work(), None);
    };
    let scope = device.push_error_scope(filter);
    let (done, error) = with_error_scopes(device, inner, work);
    let own = poll_once(scope.pop());
    (done, error.or(own))
}

/// Returns the result of a future that is ready immediately.
fn poll_once<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => None,
    }
}
