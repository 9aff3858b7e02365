//! A canvas with its device.

use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use shadowgraph::core::Format;
use shadowgraph::{Gpu, wgpu};
use web_sys::HtmlCanvasElement;

use crate::error::Error;

/// The format of canvases.
const FORMAT: Format = Format::Rgba8Unorm;
/// The format of images: that of colours, whose texels are copied to the canvas as they are.
const IMAGE: Format = Format::Rgba8UnormSrgb;

/// A canvas of a page, and a device that draws on it.
pub struct Canvas {
    element: HtmlCanvasElement,
    surface: wgpu::Surface<'static>,
    gpu: Gpu,
    /// What the adapter has beyond the device.
    adapter: wgpu::Adapter,
    events: Arc<Mutex<Events>>,
}

/// What the browser reports between frames.
#[derive(Default)]
struct Events {
    lost: Option<String>,
    error: Option<String>,
}

impl Canvas {
    /// Opens a device for a canvas.
    ///
    /// # Errors
    /// [`Error::NoWebGpu`], and for a device that cannot be opened.
    pub async fn open(element: HtmlCanvasElement) -> Result<Self, Error> {
        if web_sys::window().is_some_and(|window| !window.is_secure_context()) {
            return Err(Error::NoWebGpu("it is only there for pages from https or localhost".into()));
        }
        if !wgpu::util::is_browser_webgpu_supported().await {
            return Err(Error::NoWebGpu("it offers no adapter on this machine".into()));
        }
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: wgpu::Backends::BROWSER_WEBGPU,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let target = wgpu::SurfaceTarget::Canvas(element.clone());
        let surface = instance.create_surface(target).map_err(|error| Error::NoWebGpu(error.to_string()))?;
        let options = wgpu::RequestAdapterOptions::default();
        let adapter =
            instance.request_adapter(&options).await.map_err(|error| Error::NoWebGpu(error.to_string()))?;
        let gpu = Gpu::request(&adapter).await?;
        let events = Arc::new(Mutex::new(Events::default()));
        let (lost, failed) = (events.clone(), events.clone());
        gpu.device.set_device_lost_callback(move |_, message| {
            lock(&lost).lost = Some(if message.is_empty() { "destroyed".into() } else { message });
        });
        gpu.device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            lock(&failed).error.get_or_insert_with(|| error.to_string());
        }));
        let canvas = Self { element, surface, gpu, adapter, events };
        canvas.configure();
        Ok(canvas)
    }

    /// Opens another device for the canvas, such as after a [loss](Self::lost).
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn reopen(&self) -> impl Future<Output = Result<Self, Error>> + use<> {
        Self::open(self.element.clone())
    }

    /// Returns the device.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Returns the adapter.
    #[must_use]
    pub fn adapter(&self) -> &wgpu::Adapter {
        &self.adapter
    }

    /// Returns width and height, pixels.
    #[must_use]
    pub fn size_px(&self) -> [u32; 2] {
        [self.element.width().max(1), self.element.height().max(1)]
    }

    /// Returns the width over the height.
    #[must_use]
    pub fn aspect(&self) -> f64 {
        let [width, height] = self.size_px().map(f64::from);
        width / height
    }

    /// Changes width and height, pixels, within the limits of the device.
    pub fn resize(&mut self, size_px: [u32; 2]) {
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = size_px.map(|pixels| pixels.clamp(1, limit));
        if [width, height] != self.size_px() {
            self.element.set_width(width);
            self.element.set_height(height);
            self.configure();
        }
    }

    fn configure(&self) {
        let [width, height] = self.size_px();
        self.surface.configure(
            &self.gpu.device,
            &wgpu::SurfaceConfiguration {
                usage: wgpu::TextureUsages::COPY_DST,
                format: FORMAT,
                width,
                height,
                present_mode: wgpu::PresentMode::Fifo,
                desired_maximum_frame_latency: 2,
                alpha_mode: wgpu::CompositeAlphaMode::Opaque,
                color_space: Default::default(),
                view_formats: Vec::new(),
            },
        );
    }

    /// Creates a texture for an image of the size of the canvas, which [`show`](Self::show) shows.
    #[must_use]
    pub fn image(&self) -> wgpu::Texture {
        let [width, height] = self.size_px();
        self.gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("image"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: IMAGE,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        })
    }

    /// Submits an encoder, and shows columns of images of the size of the canvas, without a change of their texels.
    pub fn show(&self, mut encoder: wgpu::CommandEncoder, parts: &[(&wgpu::Texture, Range<u32>)]) {
        use wgpu::CurrentSurfaceTexture::{Suboptimal, Success};
        let shown = match self.surface.get_current_texture() {
            Success(texture) | Suboptimal(texture) => texture,
            // Hidden: the next frame may do better.
            _ => {
                self.gpu.queue.submit([encoder.finish()]);
                return;
            }
        };
        for (image, columns) in parts.iter().filter(|(_, columns)| !columns.is_empty()) {
            let at = |texture| wgpu::TexelCopyTextureInfo {
                texture,
                mip_level: 0,
                origin: wgpu::Origin3d { x: columns.start, y: 0, z: 0 },
                aspect: wgpu::TextureAspect::All,
            };
            let size = wgpu::Extent3d { width: columns.end - columns.start, ..image.size() };
            encoder.copy_texture_to_texture(at(image), at(&shown.texture), size);
        }
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.queue.present(shown);
    }

    /// Returns why the device is lost; `None` while it is not.
    #[must_use]
    pub fn lost(&self) -> Option<String> {
        lock(&self.events).lost.clone()
    }

    /// Returns the first error that the browser has reported since the last call.
    pub fn take_error(&self) -> Option<String> {
        lock(&self.events).error.take()
    }
}

fn lock(events: &Mutex<Events>) -> MutexGuard<'_, Events> {
    events.lock().unwrap_or_else(PoisonError::into_inner)
}
