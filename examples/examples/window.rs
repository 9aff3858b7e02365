//! The built-in scene in a window: each frame the graph draws into the texture that the surface gives.
//!
//! `cargo run -p shadowgraph-examples --example window`; with `-- --frames N` it ends after N frames.
#![allow(clippy::print_stderr, reason = "an example is a program")]

use glam::{DQuat, DVec3};
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Projection, demo::demo_scene};
use shadowgraph::shadows::ShadowSettings;
use shadowgraph::{Gpu, Renderer, ViewOptions, wgpu};
use std::{process::ExitCode, sync::Arc};
use winit::application::ApplicationHandler;
use winit::dpi::{LogicalSize, PhysicalSize};
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowAttributes, WindowId};

type Failure = Box<dyn std::error::Error>;

fn main() -> ExitCode {
    let Err(error) = run() else { return ExitCode::SUCCESS };
    eprintln!("error: {error}");
    ExitCode::FAILURE
}

fn run() -> Result<(), Failure> {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let frames = match &arguments[..] {
        [] => u64::MAX,
        [name, count] if name == "--frames" => count.parse().map_err(|_| "--frames needs a number")?,
        _ => return Err("usage: window [--frames N]".into()),
    };
    let event_loop = EventLoop::new().map_err(|error| format!("there is no display: {error}"))?;
    let display = Box::new(event_loop.owned_display_handle());
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(display));
    let mut app = App { instance, frames, screen: None, failure: None };
    event_loop.run_app(&mut app)?;
    app.failure.map_or(Ok(()), Err)
}

struct App {
    instance: wgpu::Instance,
    frames: u64,
    /// There is no window before the event loop runs.
    screen: Option<Screen>,
    failure: Option<Failure>,
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        match Screen::new(event_loop, &self.instance) {
            Ok(screen) => self.screen = Some(screen),
            Err(failure) => self.fail(event_loop, failure),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(screen) = &mut self.screen else { return };
        match event {
            WindowEvent::CloseRequested => event_loop.exit(),
            WindowEvent::Resized(size) => screen.resize(size),
            WindowEvent::RedrawRequested => match screen.draw() {
                Ok(()) if screen.drawn >= self.frames => event_loop.exit(),
                Ok(()) => screen.window.request_redraw(),
                Err(failure) => self.fail(event_loop, failure),
            },
            _ => {}
        }
    }
}

impl App {
    fn fail(&mut self, event_loop: &ActiveEventLoop, failure: Failure) {
        self.failure = Some(failure);
        event_loop.exit();
    }
}

struct Screen {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    gpu: Gpu,
    renderer: Renderer,
    drawn: u64,
}

impl Screen {
    fn new(event_loop: &ActiveEventLoop, instance: &wgpu::Instance) -> Result<Self, Failure> {
        let attributes = WindowAttributes::default().with_title("Shadowgraph");
        let attributes = attributes.with_inner_size(LogicalSize::new(960, 540));
        let window = Arc::new(event_loop.create_window(attributes)?);
        let surface = instance.create_surface(window.clone())?;
        let wanted = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&wanted))?;
        // Any device will do; this one has the features that shadows are quickest with.
        let gpu = Gpu::from_adapter(&adapter)?;
        let PhysicalSize { width, height } = window.inner_size();
        let config = surface.get_default_config(&adapter, width, height);
        let mut config = config.ok_or("this adapter cannot draw into this window")?;
        // Light is written, which the format is to encode.
        let srgb = surface.get_capabilities(&adapter).formats.into_iter().find(|format| format.is_srgb());
        config.format = srgb.ok_or("this window has no sRGB format")?;
        config.present_mode = wgpu::PresentMode::Fifo;
        let renderer = Renderer::new(&gpu, demo_scene(), &camera(0), Aov::Color)?;
        let mut screen = Self { window, surface, config, gpu, renderer, drawn: 0 };
        screen.resize(PhysicalSize { width, height });
        Ok(screen)
    }

    fn resize(&mut self, size: PhysicalSize<u32>) {
        // A minimised window has no size, and a surface must have one.
        (self.config.width, self.config.height) = (size.width.max(1), size.height.max(1));
        self.surface.configure(&self.gpu.device, &self.config);
        self.window.request_redraw();
    }

    fn draw(&mut self) -> Result<(), Failure> {
        use wgpu::CurrentSurfaceTexture::{Lost, Outdated, Suboptimal, Success, Validation};
        let surface_texture = match self.surface.get_current_texture() {
            Success(texture) | Suboptimal(texture) => texture,
            Outdated => {
                self.surface.configure(&self.gpu.device, &self.config);
                return Ok(());
            }
            Lost | Validation => return Err("the surface is lost".into()),
            // Hidden or late: the next frame may do better.
            _ => return Ok(()),
        };
        let size_px = [self.config.width, self.config.height];
        let options = ViewOptions { camera: camera(self.drawn), size_px, shadows: ShadowSettings::default() };
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        // Imports the surface's texture into the frame. Work of your own can go before and after.
        self.renderer.record(&self.gpu, &mut encoder, &surface_texture.texture, &options)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.queue.present(surface_texture);
        self.drawn += 1;
        Ok(())
    }
}

/// Swings slowly around the courtyard.
fn camera(frame: u64) -> Camera {
    let target = DVec3::new(-2.3, 1.7, -4.6);
    let angle = 0.3 * (frame as f64 * 0.01).sin();
    let eye = target + DQuat::from_rotation_y(angle) * DVec3::new(11.9, 3.2, 19.0);
    let projection = Projection::Perspective { fov_y: 0.8, near: 0.1, far: Some(320.0) };
    Camera::look_at(eye, target, DVec3::Y, projection)
}
