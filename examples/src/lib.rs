//! What the examples share: a program that draws one picture, or many, without a window, and the same in a window.
//!
//! An example draws into a texture that it is given. Without a word that texture is written to `out/NAME.png`; with `--window` it is
//! shown, frame by frame.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "examples are programs")]

mod headless;
mod window;

use shadowgraph::core::Format;
use shadowgraph::options::AdapterChoice;
use shadowgraph::{Gpu, wgpu};
use std::process::ExitCode;

/// What can go wrong in an example: its message is shown, and the program ends.
pub type Failure = Box<dyn std::error::Error>;

/// An example: what it keeps, and how it draws a frame.
pub trait Example: Sized {
    /// What it is called, and its picture.
    const NAME: &'static str;
    /// How large its picture is; a window may have any size.
    const SIZE_PX: [u32; 2] = [640, 360];
    /// How many frames are drawn without a window, where `--frames` says nothing.
    const FRAMES: u32 = 1;
    /// Whether each frame is a picture of its own, and not the last alone.
    const SEQUENCE: bool = false;

    /// What the one word of the command line says that is the example's own; empty where there is none.
    const WORD: &'static str = "";

    /// Makes what it keeps from frame to frame, by its word.
    ///
    /// # Errors
    /// Whatever the example cannot do.
    fn new(gpu: &Gpu, word: Option<&str>) -> Result<Self, Failure>;

    /// Draws a frame over all of the canvas.
    ///
    /// # Errors
    /// Whatever the example cannot do.
    fn draw(&mut self, canvas: Canvas<'_>) -> Result<(), Failure>;
}

/// What an example draws into.
pub struct Canvas<'a> {
    /// The device.
    pub gpu: &'a Gpu,
    /// Into which the frame is recorded; whoever has it submits it.
    pub encoder: &'a mut wgpu::CommandEncoder,
    /// The texture, of [`FORMAT`], which can be drawn into and copied to.
    pub target: &'a wgpu::Texture,
    /// The frame's number, from 0.
    pub number: u32,
}

/// The format of the textures that examples draw into.
pub const FORMAT: Format = Format::Rgba8UnormSrgb;

/// What the command line says.
struct Arguments {
    window: bool,
    frames: Option<u32>,
    word: Option<String>,
}

/// Runs an example as the command line says; the main function of its program.
pub fn main_of<E: Example>() -> ExitCode {
    let run = || -> Result<(), Failure> {
        let arguments = arguments::<E>(std::env::args().skip(1))?;
        match arguments.window {
            true => window::run::<E>(&arguments),
            false => headless::run::<E>(&Gpu::open(&AdapterChoice::Auto)?, &arguments),
        }
    };
    let Err(error) = run() else { return ExitCode::SUCCESS };
    eprintln!("error: {error}");
    ExitCode::FAILURE
}

fn arguments<E: Example>(mut given: impl Iterator<Item = String>) -> Result<Arguments, Failure> {
    let mut arguments = Arguments { window: false, frames: None, word: None };
    while let Some(word) = given.next() {
        match word.as_str() {
            "--window" => arguments.window = true,
            "--frames" => match given.next().map(|count| count.parse()) {
                Some(Ok(frames @ 1..)) => arguments.frames = Some(frames),
                _ => return Err("--frames: give a number, from 1 up".into()),
            },
            _ if E::WORD.is_empty() || arguments.word.is_some() || word.starts_with('-') => {
                let own = if E::WORD.is_empty() { String::new() } else { format!(", and {}", E::WORD) };
                return Err(format!("`{word}`: {} takes --window, --frames N{own}", E::NAME).into());
            }
            _ => arguments.word = Some(word),
        }
    }
    Ok(arguments)
}

/// The texture that an example draws into.
fn target(device: &wgpu::Device, [width, height]: [u32; 2]) -> wgpu::Texture {
    use wgpu::TextureUsages as Usage;
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("picture"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: Usage::RENDER_ATTACHMENT | Usage::TEXTURE_BINDING | Usage::COPY_SRC | Usage::COPY_DST,
        view_formats: &[],
    })
}
