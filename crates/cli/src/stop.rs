//! `shadowgraph render --stop-at`.

use super::args::RenderArgs;
use super::commands::{check_output, input, play};
use super::console;
use super::failure::Failure;
use super::frame_files::FrameFiles;
use super::progress::Progress;
use shadowgraph::inspect::VersionImage;
use shadowgraph::options::OptionError;
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::{Gpu, Registry};

/// `shadowgraph render --stop-at`
pub(crate) fn stop_at(
    texture: &str,
    version: u32,
    args: &RenderArgs,
    registry: &Registry,
) -> Result<(), Failure> {
    check_output(&args.output)?;
    let FrameFiles::Last(file) = FrameFiles::parse(&args.output)? else {
        return Err(OptionError::new("stop_at", "only one image is written; expected -o without %").into());
    };
    let input = input(&args.draw, registry)?;
    let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
    let drawing = Progress::if_slow("drawing");
    let (mut renderer, view) = play(&gpu, input, args.frames, &drawing, &mut |_, _| Ok(()))?;
    let failed = |error: shadowgraph::Error| OptionError::new("stop_at", error.to_string());
    let VersionImage { pass, size_px: [width, height], rgb8, range } =
        renderer.stop_at(&gpu, &view, texture, version).map_err(failed)?;
    write_png(&file, width, height, Pixels::Rgb, &rgb8)?;
    let range = range.map_or(String::new(), |[low, high]| format!(", black {low}, white {high}"));
    let file = file.display();
    console::print(&format!("wrote {file}: {width}x{height}, written by {pass}{range}\n"))
}
