//! The event handler of the window.

use std::path::{Path, PathBuf};
use std::time::Instant;

use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::ActiveEventLoop;
use winit::window::WindowId;

use super::panel::Action;
use super::screen::Screen;
use super::stage::Stage;
use crate::failure::Failure;
use crate::recording;
use shadowgraph::options::AdapterChoice;
use shadowgraph::output::write_text;
use shadowgraph::wgpu;

/// Directory for saved dumps and settings.
const FOLDER: &str = "out";

pub(super) struct App {
    instance: wgpu::Instance,
    adapter: AdapterChoice,
    /// Initial size of the window.
    size_px: [u32; 2],
    stage: Stage,
    /// `None` until the event loop runs.
    screen: Option<Screen>,
    drawn: Instant,
    failure: Option<Failure>,
    /// The file of `--record`.
    record: Option<PathBuf>,
}

impl App {
    pub(super) fn new(
        instance: wgpu::Instance,
        adapter: AdapterChoice,
        size_px: [u32; 2],
        stage: Stage,
        record: Option<PathBuf>,
    ) -> Self {
        let drawn = Instant::now();
        Self { instance, adapter, size_px, stage, screen: None, drawn, failure: None, record }
    }

    /// Returns the result of the program after the window is closed.
    pub(super) fn end(mut self) -> Result<(), Failure> {
        if let (Some(file), Some(recorder)) = (&self.record, self.stage.take_recorder()) {
            recording::write(file, &recorder)?;
        }
        self.failure.map_or(Ok(()), Err)
    }

    fn fail(&mut self, event_loop: &ActiveEventLoop, error: shadowgraph::Error) {
        self.failure = Some(match error {
            shadowgraph::Error::NoAdapter { .. } | shadowgraph::Error::NoDevice { .. } => {
                Failure::no_device(error)
            }
            error => error.into(),
        });
        event_loop.exit();
    }

    fn draw(&mut self) -> Result<(), shadowgraph::Error> {
        let Some(screen) = &mut self.screen else { return Ok(()) };
        let size = screen.window.inner_size();
        // A minimised window shows nothing.
        if size.width == 0 || size.height == 0 || screen.window.is_minimized() == Some(true) {
            return Ok(());
        }
        let seconds = self.drawn.elapsed().as_secs_f64();
        self.drawn = Instant::now();
        self.stage.reload();
        let seconds = self.stage.follow_page(seconds);
        self.stage.playback.advance(&self.stage.scene.hierarchy, self.stage.tracks.end_s(), seconds);
        self.stage.move_sun(seconds)?;
        let context = screen.input.egui_ctx();
        if !context.egui_wants_keyboard_input() {
            let input = context.input(super::panel::fly_input);
            self.stage.fly.update(input, seconds);
        }
        let action = screen.draw(&mut self.stage)?;
        if let (Some(file), Some(recorder)) = (&self.record, self.stage.recording_to_save())
            && let Err(failure) = recording::write(file, recorder)
        {
            self.stage.file_error = Some(failure.message);
        }
        screen.update_title(&self.stage);
        screen.window.request_redraw();
        match action {
            Some(Action::SaveDump { size_px }) => {
                let page = self.stage.page(&screen.gpu, size_px)?;
                self.save("frame.html", &page);
            }
            Some(Action::SaveSettings) => {
                match ron::ser::to_string_pretty(&self.stage.settings, Default::default()) {
                    Ok(text) => self.save("settings.ron", &text),
                    Err(error) => self.stage.file_error = Some(error.to_string()),
                }
            }
            Some(Action::Open(file)) => self.stage.open(file.as_deref()),
            None => {}
        }
        Ok(())
    }

    fn save(&mut self, name: &str, text: &str) {
        let file: PathBuf = Path::new(FOLDER).join(name);
        match write_text(&file, text) {
            Ok(()) => self.stage.note = format!("wrote {}", file.display()),
            Err(error) => self.stage.file_error = Some(error.to_string()),
        }
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.screen.is_some() {
            return;
        }
        match Screen::new(event_loop, &self.instance, &self.adapter, self.size_px) {
            Ok(screen) => {
                screen.window.request_redraw();
                self.screen = Some(screen);
            }
            Err(error) => self.fail(event_loop, error),
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(screen) = &mut self.screen else { return };
        let response = screen.input.on_window_event(&screen.window, &event);
        if response.repaint {
            screen.window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::Resized(size) => {
                if let Err(error) = screen.resize(size) {
                    self.fail(event_loop, error);
                }
            }
            WindowEvent::DroppedFile(file) => self.stage.open(Some(&file)),
            WindowEvent::Focused(_) | WindowEvent::Occluded(false) => screen.window.request_redraw(),
            WindowEvent::RedrawRequested => {
                if let Err(error) = self.draw() {
                    self.fail(event_loop, error);
                }
            }
            _ => {}
        }
    }
}
