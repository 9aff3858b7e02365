//! The same frames in a window: each is drawn into a texture, and a graph draws that into the surface texture.

use crate::{Arguments, Canvas, Example, Failure, target};
use shadowgraph::core::{FullscreenShader, Graph};
use shadowgraph::{Gpu, wgpu};
use std::sync::Arc;
use winit::application::ApplicationHandler;
use winit::dpi::{PhysicalSize, Size};
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowAttributes, WindowId};

const SHOW: &str = "
    @group(0) @binding(0) var image: texture_2d<f32>;

    @fragment
    fn show(@builtin(position) position: vec4f) -> @location(0) vec4f {
        return textureLoad(image, vec2u(position.xy), 0);
    }";

pub(crate) fn run<E: Example>(arguments: &Arguments) -> Result<(), Failure> {
    let event_loop = EventLoop::new().map_err(|error| format!("there is no display: {error}"))?;
    let display = Box::new(event_loop.owned_display_handle());
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(display));
    let mut app = App::<E> { instance, arguments, screen: None, failure: None };
    event_loop.run_app(&mut app)?;
    app.failure.map_or(Ok(()), Err)
}

struct App<'a, E> {
    instance: wgpu::Instance,
    arguments: &'a Arguments,
    /// `None` until the event loop runs.
    screen: Option<Screen<E>>,
    failure: Option<Failure>,
}

impl<E: Example> ApplicationHandler for App<'_, E> {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        match Screen::new(event_loop, &self.instance, self.arguments) {
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
                Ok(()) if Some(screen.drawn) == self.arguments.frames => event_loop.exit(),
                Ok(()) => screen.window.request_redraw(),
                Err(failure) => self.fail(event_loop, failure),
            },
            _ => {}
        }
    }
}

impl<E> App<'_, E> {
    fn fail(&mut self, event_loop: &ActiveEventLoop, failure: Failure) {
        self.failure = Some(failure);
        event_loop.exit();
    }
}

struct Screen<E> {
    example: E,
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
    gpu: Gpu,
    graph: Graph,
    show: FullscreenShader,
    image: wgpu::Texture,
    drawn: u32,
}

impl<E: Example> Screen<E> {
    fn new(
        event_loop: &ActiveEventLoop,
        instance: &wgpu::Instance,
        arguments: &Arguments,
    ) -> Result<Self, Failure> {
        let size = Size::Physical(arguments.size_px.into());
        let attributes = WindowAttributes::default().with_title(E::NAME).with_inner_size(size);
        let window = Arc::new(event_loop.create_window(attributes)?);
        let surface = instance.create_surface(window.clone())?;
        let wanted = wgpu::RequestAdapterOptions { compatible_surface: Some(&surface), ..Default::default() };
        let adapter = pollster::block_on(instance.request_adapter(&wanted))?;
        // Any device works; this one has the features with which shadows are fastest.
        let gpu = Gpu::from_adapter(&adapter)?;
        let PhysicalSize { width, height } = window.inner_size();
        let config = surface.get_default_config(&adapter, width, height);
        let mut config = config.ok_or("this adapter cannot draw into this window")?;
        // Shaders write linear colours, so the format has to encode them.
        let srgb = surface.get_capabilities(&adapter).formats.into_iter().find(|format| format.is_srgb());
        config.format = srgb.ok_or("this window has no sRGB format")?;
        config.present_mode = wgpu::PresentMode::Fifo;
        let mut screen = Self {
            example: E::new(&gpu, arguments.argument.as_deref())?,
            window,
            surface,
            config,
            graph: Graph::new(),
            show: FullscreenShader::wgsl("show", SHOW),
            image: target(&gpu.device, arguments.size_px),
            gpu,
            drawn: 0,
        };
        screen.resize(PhysicalSize { width, height });
        Ok(screen)
    }

    fn resize(&mut self, size: PhysicalSize<u32>) {
        // A minimised window has size 0, which a surface must not have.
        (self.config.width, self.config.height) = (size.width.max(1), size.height.max(1));
        self.surface.configure(&self.gpu.device, &self.config);
        self.image = target(&self.gpu.device, [self.config.width, self.config.height]);
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
            // The window is hidden, or the frame timed out: try again in the next frame.
            _ => return Ok(()),
        };
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let (gpu, target, number) = (&self.gpu, &self.image, self.drawn);
        self.example.draw(Canvas { gpu, encoder: &mut encoder, target, number, server: None })?;
        let mut frame = self.graph.frame();
        let image = frame.import_texture("image", &self.image, true);
        let mut surface = frame.import_texture("surface", &surface_texture.texture, false);
        frame.fullscreen("show", &self.show).sample(&image).draw(&mut surface);
        self.graph.compile(frame)?.execute(&mut self.graph, &self.gpu.device, &mut encoder)?;
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.queue.present(surface_texture);
        self.drawn += 1;
        Ok(())
    }
}
