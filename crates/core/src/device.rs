//! What a device says where there is not enough memory, or where it is gone.

use crate::error::Error;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Colour attachments that a render pass has at most, on any device; `internal.wgsl` has the same number.
pub(crate) const MAX_COLOR_ATTACHMENTS: usize = 8;

/// Returns whether a device is lost: destroyed, removed, or given up by its driver. wgpu says so to the callback of
/// `Device::set_device_lost_callback` alone, and as late as in `Device::poll`; this asks, for about as much as the creation of a
/// small buffer costs. Nothing brings a lost device back: open another, and make anew what was made on it, the
/// [`Graph`](crate::Graph) too.
///
/// ```
/// use shadowgraph_core::{device_is_lost, wgpu};
/// let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// assert!(!device_is_lost(&device));
/// device.destroy();
/// assert!(device_is_lost(&device));
/// ```
pub fn device_is_lost(device: &wgpu::Device) -> bool {
    // A lost device gives out a buffer without a word, but no call takes it.
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("is the device lost?"),
        size: wgpu::COPY_BUFFER_ALIGNMENT,
        usage: wgpu::BufferUsages::MAP_WRITE,
        mapped_at_creation: false,
    });
    buffer.map_async(wgpu::MapMode::Write, .., drop);
    now(scope.pop()).is_some()
}

/// Makes a texture or buffer of `bytes` bytes, and an error of what stands against it. `name` is for the error.
pub(crate) fn make<T>(
    device: &wgpu::Device,
    name: &str,
    bytes: u64,
    make: impl FnOnce(&wgpu::Device) -> T,
) -> Result<T, Error> {
    let scope = device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
    let made = make(device);
    if now(scope.pop()).is_some() {
        return Err(Error::OutOfMemory { resource: name.into(), bytes });
    }
    if device_is_lost(device) { Err(Error::DeviceLost) } else { Ok(made) }
}

/// The result of a future that is ready at once. In browsers error scopes are not, and there what wgpu says goes to the
/// console instead.
pub(crate) fn now<T>(future: impl Future<Output = Option<T>>) -> Option<T> {
    match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(result) => result,
        Poll::Pending => None,
    }
}
