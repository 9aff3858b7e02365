//! `shadowgraph view`: a scene in a window, with a panel next to it.

mod app;
mod fly;
mod live;
mod panel;
mod playback;
mod reload;
mod screen;
mod stage;
mod sun;

use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use app::App;
use live::Live;
use stage::Stage;
use winit::event_loop::EventLoop;

use super::args::ViewArgs;
use super::commands::{recorded_input, view_options};
use super::console;
use super::failure::Failure;
use shadowgraph::inspect::Server;
use shadowgraph::{Registry, wgpu};

/// `shadowgraph view`
pub(crate) fn view(args: &ViewArgs, registry: &Registry) -> Result<(), Failure> {
    let input = recorded_input(&args.draw, registry, args.record.limit_mib())?;
    let event_loop = EventLoop::new().map_err(|error| no_display(&error))?;
    let display = Box::new(event_loop.owned_display_handle());
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle(display));
    let adapter = input.options.adapter.clone();
    let view = view_options(&input)?;
    let size_px = view.size_px;
    let mut stage = Stage::new(input, view, registry.clone(), args)?;
    if let Some(port) = args.serve {
        let server = Server::start(port, "shadowgraph view")?;
        console::print(&format!("{}\n", server.url()))?;
        stage.live = Some(Live::new(server));
    }
    let mut app = App::new(instance, adapter, size_px, stage, args.record.file.clone());
    run(event_loop, &mut app)?;
    app.end()
}

/// Runs the window until it is closed. winit panics if the display goes away in the middle of a frame: that is an error of one line.
fn run(event_loop: EventLoop<()>, app: &mut App) -> Result<(), Failure> {
    let is_lost = Arc::new(AtomicBool::new(false));
    let (lost, report) = (is_lost.clone(), panic::take_hook());
    panic::set_hook(Box::new(move |info| {
        if info.location().is_some_and(|location| location.file().contains("winit")) {
            lost.store(true, Ordering::Relaxed);
        } else {
            report(info);
        }
    }));
    match panic::catch_unwind(AssertUnwindSafe(|| event_loop.run_app(app))) {
        Ok(ended) => Ok(ended?),
        Err(_) if is_lost.load(Ordering::Relaxed) => {
            Err(Failure { code: Failure::INPUT, message: "the display of the window is gone".into() })
        }
        Err(panicked) => panic::resume_unwind(panicked),
    }
}

fn no_display(error: &dyn std::fmt::Display) -> Failure {
    let text = error.to_string().replace('\n', " ");
    // Without the location in the source of the window library.
    let reason = text.rsplit_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    let reason = reason.map_or(&*text, |(_, reason)| reason);
    Failure {
        code: Failure::NO_ADAPTER,
        message: format!("there is no display to open a window on: {reason}"),
    }
}
