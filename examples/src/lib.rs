//! Shared code of the examples: a program that draws one or several images without a window, or frames in a window.
//!
//! An example draws into a texture. Without arguments that texture is written to `out/NAME.png`; with `--window` each frame is shown.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "examples are programs")]

mod headless;
mod serve;
mod window;

use shadowgraph::core::{Compiled, Format, Graph};
use shadowgraph::inspect::{FrameReport, Server};
use shadowgraph::options::AdapterChoice;
use shadowgraph::{Gpu, wgpu};
use std::process::ExitCode;

/// The error of an example: its message is printed, and the program ends.
pub type Failure = Box<dyn std::error::Error>;

/// An example: the state that it keeps, and how it draws a frame.
pub trait Example: Sized {
    /// The name of the example and of its image.
    const NAME: &'static str;
    /// The size of its image; a window may have any size.
    const SIZE_PX: [u32; 2] = [640, 360];
    /// The number of frames without a window, unless `--frames` sets it.
    const FRAMES: u32 = 1;
    /// Whether each frame is written to a file, and not only the last.
    const SEQUENCE: bool = false;
    /// Whether it executes its frames with [`Canvas::execute`], so that `--serve PORT` shows them on a page.
    const SERVES: bool = false;
    /// Description of the example's argument; empty if it has none.
    const ARGUMENT: &'static str = "";

    /// Creates the state that it keeps from frame to frame.
    ///
    /// # Errors
    /// For what the example cannot do.
    fn new(gpu: &Gpu, argument: Option<&str>) -> Result<Self, Failure>;

    /// Draws a frame that covers the canvas.
    ///
    /// # Errors
    /// For what the example cannot do.
    fn draw(&mut self, canvas: Canvas<'_>) -> Result<(), Failure>;
}

/// The target of an example.
pub struct Canvas<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// The encoder that the frame is recorded into; the caller submits it.
    pub encoder: &'a mut wgpu::CommandEncoder,
    /// The texture, of [`FORMAT`], as an attachment or the target of copies.
    pub target: &'a wgpu::Texture,
    /// The number of the frame, from 0.
    pub number: u32,
    /// Serves a page about the frames with `--serve PORT`.
    server: Option<&'a mut Server>,
}

impl Canvas<'_> {
    /// Executes a frame, and shows it to the page if one is served.
    ///
    /// # Errors
    /// As [`Compiled::execute`].
    pub fn execute(self, compiled: Compiled<'_>, graph: &mut Graph) -> Result<(), Failure> {
        let Self { gpu, encoder, server, .. } = self;
        let Some(server) = server else {
            compiled.execute(graph, &gpu.device, encoder)?;
            return Ok(());
        };
        server.begin_frame(graph);
        let mut executed = compiled.execute(graph, &gpu.device, encoder)?;
        server.end_frame(&gpu.device, &mut executed, &FrameReport { bytes: graph.bytes(), times: &[] });
        Ok(())
    }
}

/// The format of the targets.
pub const FORMAT: Format = Format::Rgba8UnormSrgb;

/// The arguments of the command line.
struct Arguments {
    window: bool,
    /// The port of a page about the frames.
    serve: Option<u16>,
    /// The size of the image, or of the window at first.
    size_px: [u32; 2],
    frames: Option<u32>,
    argument: Option<String>,
}

/// Runs an example with the arguments of the command line; the main function of its program.
pub fn run_example<E: Example>() -> ExitCode {
    let run = || -> Result<(), Failure> {
        let arguments = arguments::<E>(std::env::args().skip(1))?;
        match (arguments.window, arguments.serve) {
            (true, _) => window::run::<E>(&arguments),
            (false, Some(port)) => serve::run::<E>(&Gpu::open(&AdapterChoice::Auto)?, port, &arguments),
            (false, None) => headless::run::<E>(&Gpu::open(&AdapterChoice::Auto)?, &arguments),
        }
    };
    let Err(error) = run() else { return ExitCode::SUCCESS };
    eprintln!("error: {error}");
    ExitCode::FAILURE
}

fn arguments<E: Example>(mut given: impl Iterator<Item = String>) -> Result<Arguments, Failure> {
    let mut arguments =
        Arguments { window: false, serve: None, size_px: E::SIZE_PX, frames: None, argument: None };
    while let Some(argument) = given.next() {
        match argument.as_str() {
            "--window" => arguments.window = true,
            "--serve" if E::SERVES => match given.next().map(|port| port.parse()) {
                Some(Ok(port)) => arguments.serve = Some(port),
                _ => return Err("--serve: expected a port, 0 to 65535".into()),
            },
            "--size" => match given.next().as_deref().and_then(size_px) {
                Some(size_px) => arguments.size_px = size_px,
                None => return Err("--size: expected WIDTHxHEIGHT, 1 to 4096 pixels each".into()),
            },
            "--frames" => match given.next().map(|count| count.parse()) {
                Some(Ok(frames @ 1..)) => arguments.frames = Some(frames),
                _ => return Err("--frames: expected an integer above 0".into()),
            },
            _ if E::ARGUMENT.is_empty() || arguments.argument.is_some() || argument.starts_with('-') => {
                let expected =
                    if E::ARGUMENT.is_empty() { String::new() } else { format!(", and {}", E::ARGUMENT) };
                let serve = if E::SERVES { ", --serve PORT" } else { "" };
                return Err(format!(
                    "unexpected argument `{argument}`; expected --window{serve}, --size WxH, --frames N{expected}"
                )
                .into());
            }
            _ => arguments.argument = Some(argument),
        }
    }
    Ok(arguments)
}

/// Returns the size in pixels that a text names.
fn size_px(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once('x')?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=4096).contains(side));
    Some([side(width)?, side(height)?])
}

/// Creates the texture that an example draws into.
fn target(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Texture {
    use wgpu::TextureUsages as Usage;
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("image"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: Usage::RENDER_ATTACHMENT | Usage::TEXTURE_BINDING | Usage::COPY_SRC | Usage::COPY_DST,
        view_formats: &[],
    })
}
