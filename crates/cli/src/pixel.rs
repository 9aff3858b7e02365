//! `shadowgraph pixel`.

use std::path::Path;

use serde_json::json;

use super::args::PixelArgs;
use super::commands::{input, play};
use super::console;
use super::failure::Failure;
use super::progress::Progress;
use super::replay;
use shadowgraph::inspect::PixelHistory;
use shadowgraph::options::OptionError;
use shadowgraph::output::write_text;
use shadowgraph::{Gpu, Registry, RenderConfig, Renderer, ViewOptions};
use shadowgraph_quality::{PixelShadows, ShadowInspector};

/// `shadowgraph pixel`
pub(crate) fn pixel(args: &PixelArgs, registry: &Registry) -> Result<(), Failure> {
    let is_json = args.output.as_deref().map_or(Ok(false), is_json)?;
    let (history, shadows) = match args.replay.file()? {
        Some(file) => {
            replay::with_frame((file, &args.draw, registry), args.replay.frame, |gpu, renderer, view| {
                let config = renderer.config().clone();
                explained(gpu, renderer, (view, &config), args.pixel)
            })?
        }
        None => {
            let input = input(&args.draw, registry)?;
            let config = input.options.render_config();
            let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
            let drawing = Progress::if_slow("drawing");
            let (mut renderer, view) = play(&gpu, input, args.frames, &drawing, &mut |_, _| Ok(()))?;
            explained(&gpu, &mut renderer, (&view, &config), args.pixel)?
        }
    };
    let text = if is_json {
        serde_json::to_string_pretty(&json!({ "history": history, "shadows": shadows }))? + "\n"
    } else {
        format!("{}\n{}", history.to_text(), shadows.to_text())
    };
    match &args.output {
        Some(file) => {
            write_text(file, &text)?;
            console::print(&format!("wrote {}\n", file.display()))
        }
        None => console::print(&text),
    }
}

/// Returns the history and the shadows of a pixel in a frame of a renderer, which `config` is of.
pub(crate) fn explained(
    gpu: &Gpu,
    renderer: &mut Renderer,
    (view, config): (&ViewOptions, &RenderConfig),
    pixel: [u32; 2],
) -> Result<(PixelHistory, PixelShadows), Failure> {
    let (_, history) = renderer.pixel_history(gpu, view, pixel)?;
    let shadows = ShadowInspector::new(gpu, renderer.scene(), view, config)?.shadows_at(pixel)?;
    Ok((history, shadows))
}

/// Returns whether a file is JSON, not text, by its extension.
fn is_json(file: &Path) -> Result<bool, OptionError> {
    let extension = file.extension().map(|extension| extension.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("json") => Ok(true),
        Some("txt") | None => Ok(false),
        Some(other) => Err(OptionError::new(
            "output",
            format!("unknown extension `.{other}`; expected one of: txt, json"),
        )),
    }
}
