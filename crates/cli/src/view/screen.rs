//! The window: a surface, egui, and the texture that the scene is drawn into.

use std::sync::Arc;

use egui::{TextureId, ViewportId};
use egui_wgpu::{RendererOptions, ScreenDescriptor};
use winit::dpi::{LogicalSize, PhysicalSize};
use winit::event_loop::ActiveEventLoop;
use winit::window::{Window, WindowAttributes};

use super::panel::{Action, Panel, Shown};
use super::stage::Stage;
use shadowgraph::core::Format;
use shadowgraph::options::AdapterChoice;
use shadowgraph::{Error, Gpu, wgpu};

/// A window with a device.
pub(super) struct Screen {
    pub(super) window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    pub(super) gpu: Gpu,
    pub(super) input: egui_winit::State,
    painter: egui_wgpu::Renderer,
    panel: Panel,
    scene_texture: Option<SceneTexture>,
    /// Title of the window, because not every window system returns it.
    title: String,
}

/// The texture that the scene is drawn into, with its id in egui.
struct SceneTexture {
    texture: wgpu::Texture,
    id: TextureId,
}

impl Screen {
    pub(super) fn new(
        event_loop: &ActiveEventLoop,
        instance: &wgpu::Instance,
        adapter: &AdapterChoice,
        [width, height]: [u32; 2],
    ) -> Result<Self, Error> {
        let refused = |error: &dyn std::fmt::Display| Error::Gpu(format!("cannot open a window: {error}"));
        let attributes = WindowAttributes::default().with_title("Shadowgraph");
        let attributes = attributes.with_inner_size(LogicalSize::new(width, height));
        let window = event_loop.create_window(attributes).map_err(|error| refused(&error))?;
        let window = Arc::new(window);
        let surface = instance.create_surface(window.clone()).map_err(|error| refused(&error))?;
        let (gpu, adapter) = Gpu::for_surface(instance, &surface, adapter)?;
        let PhysicalSize { width, height } = window.inner_size();
        let config = surface.get_default_config(&adapter, width.max(1), height.max(1));
        let mut config = config.ok_or_else(|| refused(&"the adapter does not support its surface"))?;
        let formats = surface.get_capabilities(&adapter).formats;
        // egui writes encoded colours.
        config.format = formats.iter().copied().find(|format| !format.is_srgb()).unwrap_or(config.format);
        config.present_mode = wgpu::PresentMode::Fifo;
        surface.configure(&gpu.device, &config);
        let limit = gpu.device.limits().max_texture_dimension_2d as usize;
        let context = egui::Context::default();
        let input =
            egui_winit::State::new(context, ViewportId::ROOT, &window, None, window.theme(), Some(limit));
        let painter = egui_wgpu::Renderer::new(&gpu.device, config.format, RendererOptions::default());
        let (panel, scene_texture, title) = (Panel::default(), None, String::new());
        Ok(Self { window, surface, config, gpu, input, painter, panel, scene_texture, title })
    }

    pub(super) fn resize(&mut self, size: PhysicalSize<u32>) -> Result<(), Error> {
        // A minimised window has no size, and a surface must have one.
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        (self.config.width, self.config.height) = (size.width.clamp(1, limit), size.height.clamp(1, limit));
        self.configure()
    }

    /// Updates the title of the window.
    pub(super) fn update_title(&mut self, stage: &Stage) {
        let title = format!("Shadowgraph: {}, {}", stage.technique.name(), stage.pipeline.name());
        if self.title != title {
            self.window.set_title(&title);
            self.title = title;
        }
    }

    /// Draws the scene and the panel, and returns the requested action.
    #[allow(clippy::iter_over_hash_type, reason = "textures are created and freed in any order")]
    pub(super) fn draw(&mut self, stage: &mut Stage) -> Result<Option<Action>, Error> {
        let raw = self.input.take_egui_input(&self.window);
        let context = self.input.egui_ctx().clone();
        let (id, gpu) = (self.scene_texture.as_ref().map(|scene_texture| scene_texture.id), &self.gpu);
        let (panel, mut shown) = (&mut self.panel, None);
        let output = context.run_ui(raw, |ui| shown = Some(panel.show(ui, stage, id, &gpu.adapter.name)));
        self.input.handle_platform_output(&self.window, output.platform_output);
        let scale = output.pixels_per_point;
        let shapes = context.tessellate(output.shapes, scale);
        // egui calls the closure at least once.
        let shown = shown.unwrap_or(Shown { size_points: [1.0; 2], action: None });
        let size_px = shown.size_points.map(|points| ((points * scale) as u32).clamp(1, self.limit()));
        self.draw_scene(stage, size_px);
        let mut textures = output.textures_delta;
        for (id, deltas) in &textures.set {
            for delta in deltas {
                self.painter.update_texture(&self.gpu.device, &self.gpu.queue, *id, delta);
            }
        }
        let painted = self.paint(&shapes, scale);
        for id in &textures.free {
            self.painter.free_texture(id);
        }
        // egui panics if unprocessed deltas are dropped.
        textures.clear();
        painted?;
        Ok(shown.action)
    }

    fn limit(&self) -> u32 {
        self.gpu.device.limits().max_texture_dimension_2d
    }

    /// Draws the scene into a texture of the given size, which is created again if the size has changed.
    fn draw_scene(&mut self, stage: &mut Stage, size_px: [u32; 2]) {
        let format = stage.format();
        let fits = |scene_texture: &SceneTexture| {
            [scene_texture.texture.width(), scene_texture.texture.height()] == size_px
                && scene_texture.texture.format() == format
        };
        if !self.scene_texture.as_ref().is_some_and(fits) {
            let texture = target(&self.gpu.device, size_px, format);
            let view = texture.create_view(&wgpu::TextureViewDescriptor {
                format: Some(Format::Rgba8Unorm),
                usage: Some(wgpu::TextureUsages::TEXTURE_BINDING),
                ..Default::default()
            });
            let filter = wgpu::FilterMode::Linear;
            let id = match &self.scene_texture {
                Some(old) => {
                    let (device, id) = (&self.gpu.device, old.id);
                    self.painter.update_egui_texture_from_wgpu_texture(device, &view, filter, id);
                    id
                }
                None => self.painter.register_native_texture(&self.gpu.device, &view, filter),
            };
            self.scene_texture = Some(SceneTexture { texture, id });
        }
        if let Some(scene_texture) = &self.scene_texture {
            stage.draw(&self.gpu, &scene_texture.texture);
        }
    }

    /// Configures the surface for the window, which fails if the window is lost.
    fn configure(&self) -> Result<(), Error> {
        let Self { gpu, surface, config, .. } = self;
        let configured = gpu.checked(|| -> Result<(), Error> {
            surface.configure(&gpu.device, config);
            Ok(())
        });
        configured.map_err(window_lost)
    }

    fn paint(&mut self, shapes: &[egui::ClippedPrimitive], scale: f32) -> Result<(), Error> {
        use wgpu::CurrentSurfaceTexture::{Lost, Outdated, Suboptimal, Success, Validation};
        let Self { gpu, surface, .. } = self;
        let target =
            match gpu.checked(|| Ok::<_, Error>(surface.get_current_texture())).map_err(window_lost)? {
                Success(texture) | Suboptimal(texture) => texture,
                Outdated | Lost => return self.configure(),
                Validation => return Err(window_lost("its surface is no longer valid")),
                // Hidden or late: the next frame may do better.
                _ => return Ok(()),
            };
        let Self { gpu, painter, config, .. } = self;
        let (device, queue) = (&gpu.device, &gpu.queue);
        let size_in_pixels = [config.width, config.height];
        let screen = ScreenDescriptor { size_in_pixels, pixels_per_point: scale };
        let painted = gpu.checked(|| -> Result<(), Error> {
            let mut encoder = device.create_command_encoder(&Default::default());
            let commands = painter.update_buffers(device, queue, &mut encoder, shapes, &screen);
            let view = target.texture.create_view(&Default::default());
            let pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("panel"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &view,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color::BLACK),
                        store: wgpu::StoreOp::Store,
                    },
                })],
                ..Default::default()
            });
            painter.render(&mut pass.forget_lifetime(), shapes, &screen);
            queue.submit(commands.into_iter().chain([encoder.finish()]));
            queue.present(target);
            Ok(())
        });
        painted.map_err(window_lost)
    }
}

/// Creates the error of a lost window.
fn window_lost(reason: impl std::fmt::Display) -> Error {
    Error::Gpu(format!("the window was lost: {reason}"))
}

fn target(device: &wgpu::Device, [width, height]: [u32; 2], format: Format) -> wgpu::Texture {
    use wgpu::TextureUsages as Usage;
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("view"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: Usage::RENDER_ATTACHMENT | Usage::TEXTURE_BINDING | Usage::COPY_DST,
        view_formats: &[Format::Rgba8Unorm],
    })
}
