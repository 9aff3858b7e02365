//! Devices for tests.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "tests")]

use std::io::Write as _;
use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake, Waker};

/// Returns wgpu's noop device, which copies buffers and draws nothing, with default limits.
pub(crate) fn noop() -> (wgpu::Device, wgpu::Queue) {
    let noop = wgpu::NoopBackendOptions { enable: true, ..Default::default() };
    let options = wgpu::BackendOptions { noop, ..Default::default() };
    open(wgpu::Backends::NOOP, options, wgpu::Features::empty()).unwrap()
}

/// Returns a device that draws, or `None` after recording a skip.
pub(crate) fn drawing() -> Option<(wgpu::Device, wgpu::Queue)> {
    open(wgpu::Backends::PRIMARY, wgpu::BackendOptions::default(), wgpu::Features::empty())
        .inspect_err(|reason| skip("core_device", reason))
        .ok()
}

/// Returns a device that draws and has these features, or `None` after recording a skip.
pub(crate) fn drawing_with(features: wgpu::Features) -> Option<(wgpu::Device, wgpu::Queue)> {
    open(wgpu::Backends::PRIMARY, wgpu::BackendOptions::default(), features)
        .inspect_err(|reason| skip("core_device_features", reason))
        .ok()
}

fn open(
    backends: wgpu::Backends,
    backend_options: wgpu::BackendOptions,
    required_features: wgpu::Features,
) -> Result<(wgpu::Device, wgpu::Queue), String> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
        backends,
        backend_options,
        ..wgpu::InstanceDescriptor::new_without_display_handle()
    });
    let adapter = block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))
        .map_err(|error| error.to_string())?;
    let desc = wgpu::DeviceDescriptor { required_features, ..Default::default() };
    block_on(adapter.request_device(&desc)).map_err(|error| error.to_string())
}

/// Runs a future on this thread, which sleeps until the future is woken.
pub(crate) fn block_on<F: Future>(future: F) -> F::Output {
    struct Unpark(std::thread::Thread);
    impl Wake for Unpark {
        fn wake(self: Arc<Self>) {
            self.0.unpark();
        }
    }
    let waker = Waker::from(Arc::new(Unpark(std::thread::current())));
    let mut future = pin!(future);
    loop {
        match future.as_mut().poll(&mut Context::from_waker(&waker)) {
            Poll::Ready(output) => return output,
            Poll::Pending => std::thread::park(),
        }
    }
}

/// Runs `work` and fails the test on a validation error of wgpu.
pub(crate) fn valid<T>(device: &wgpu::Device, work: impl FnOnce() -> T) -> T {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let result = work();
    let error = block_on(scope.pop());
    assert!(error.is_none(), "{}", error.unwrap());
    result
}

/// Records a skip as described in `CONTRIBUTING.md`.
fn skip(id: &str, reason: &str) {
    let line = format!("SKIP {id}: {}\n", reason.replace('\n', " "));
    print!("{line}");
    if let Some(log) = std::env::var_os("SHADOWGRAPH_SKIP_LOG") {
        let mut log = std::fs::OpenOptions::new().append(true).create(true).open(log).unwrap();
        log.write_all(line.as_bytes()).unwrap();
    }
}
