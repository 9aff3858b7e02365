//! The draws on a real adapter, compared texel by texel, and on the noop device, which only validates.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

mod region_clear;
mod resample;
mod stage;

use crate::desc::Format;
use std::io::Write;

/// A device with its adapter, for the capabilities of formats; the noop device has none.
struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    adapter: Option<wgpu::Adapter>,
}

/// Features for formats that not every device renders to, requested where the adapter supports them.
const FORMATS: wgpu::Features = wgpu::Features::DEPTH32FLOAT_STENCIL8
    .union(wgpu::Features::RG11B10UFLOAT_RENDERABLE)
    .union(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM)
    .union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

impl Gpu {
    /// Returns a device that draws, or logs that there is none.
    fn real() -> Option<Self> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::PRIMARY,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let adapter = match block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default())) {
            Ok(adapter) => adapter,
            Err(error) => {
                skip("internal_draws", &error.to_string());
                return None;
            }
        };
        let desc =
            wgpu::DeviceDescriptor { required_features: adapter.features() & FORMATS, ..Default::default() };
        let (device, queue) = block_on(adapter.request_device(&desc)).unwrap();
        Some(Self { device, queue, adapter: Some(adapter) })
    }

    fn noop() -> Self {
        let required_features = FORMATS.difference(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
        let (device, queue) =
            wgpu::Device::noop(&wgpu::DeviceDescriptor { required_features, ..Default::default() });
        Self { device, queue, adapter: None }
    }

    fn format_features(&self, format: Format) -> wgpu::TextureFormatFeatures {
        match &self.adapter {
            Some(adapter) => adapter.get_texture_format_features(format),
            None => format.guaranteed_format_features(self.device.features()),
        }
    }

    fn renders(&self, format: Format, samples: u32) -> bool {
        let features = self.format_features(format);
        self.device.features().contains(format.required_features())
            && features.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT)
            && features.flags.sample_count_supported(samples)
    }

    /// Records, submits and fails on a validation error.
    fn submit<T>(&self, record: impl FnOnce(&mut wgpu::CommandEncoder) -> T) -> T {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let result = record(&mut encoder);
        self.queue.submit([encoder.finish()]);
        if let Some(error) = block_on(scope.pop()) {
            panic!("{error}");
        }
        result
    }

    fn texture(&self, format: Format, size: wgpu::Extent3d, mips: u32, samples: u32) -> wgpu::Texture {
        let mut usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
        if samples == 1 {
            usage |= self.format_features(format).allowed_usages
                & (wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_SRC
                    | wgpu::TextureUsages::COPY_DST);
        }
        self.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size,
            mip_level_count: mips,
            sample_count: samples,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage,
            view_formats: &[],
        })
    }

    /// Returns the bytes of each texel of one aspect, mip and layer, row by row.
    fn read(
        &self,
        texture: &wgpu::Texture,
        aspect: wgpu::TextureAspect,
        mip: u32,
        layer: u32,
    ) -> Vec<Vec<u8>> {
        let texel = texture.format().block_copy_size(Some(aspect)).unwrap();
        let size = texture.size().mip_level_size(mip, texture.dimension());
        let row = (size.width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: u64::from(row * size.height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let from = wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: mip,
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
            aspect,
        };
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        let extent = wgpu::Extent3d { depth_or_array_layers: 1, ..size };
        self.submit(|encoder| encoder.copy_texture_to_buffer(from, to, extent));
        buffer.map_async(wgpu::MapMode::Read, .., |mapped| mapped.unwrap());
        self.device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
        let bytes = buffer.get_mapped_range(..).unwrap();
        let rows = bytes.chunks_exact(row as usize);
        rows.flat_map(|row| row[..(size.width * texel) as usize].chunks_exact(texel as usize))
            .map(<[u8]>::to_vec)
            .collect()
    }
}

/// Polls a native future, which is ready at once.
fn block_on<F: Future>(future: F) -> F::Output {
    let mut context = std::task::Context::from_waker(std::task::Waker::noop());
    match std::pin::pin!(future).poll(&mut context) {
        std::task::Poll::Ready(output) => output,
        std::task::Poll::Pending => panic!("a native future waits for nothing"),
    }
}

/// Records a skip as described in `CONTRIBUTING.md`.
#[allow(clippy::print_stdout, reason = "skips are printed")]
fn skip(id: &str, reason: &str) {
    let line = format!("SKIP {id}: {}\n", reason.replace('\n', " "));
    print!("{line}");
    if let Some(log) = std::env::var_os("SHADOWGRAPH_SKIP_LOG") {
        let mut log = std::fs::OpenOptions::new().append(true).create(true).open(log).unwrap();
        log.write_all(line.as_bytes()).unwrap();
    }
}
